// SPDX-License-Identifier: Apache-2.0
#include "generate/textures.h"

#include <iterator>

#include <glm/gtc/color_space.hpp>

#include "generate/random.h"

namespace candelabra::app
{
namespace
{

Texture makeSrgb(uint32_t width, uint32_t height)
{
    return {.width = width,
            .height = height,
            .rgba = std::vector<uint8_t>(size_t{4} * width * height, 255),
            .srgb = true};
}

void setTexel(Texture& texture, uint32_t x, uint32_t y, const glm::vec3& colour)
{
    const glm::vec3 encoded = 255.0f * glm::convertLinearToSRGB(colour) + 0.5f;
    const size_t at = 4 * (size_t{texture.width} * y + x);
    for (int i = 0; i < 3; ++i)
        texture.rgba[at + static_cast<size_t>(i)] = static_cast<uint8_t>(encoded[i]);
}

} // namespace

Texture makeGradient(const std::vector<glm::vec3>& colours)
{
    Texture texture = makeSrgb(1, static_cast<uint32_t>(colours.size()));
    texture.repeatV = false;
    for (uint32_t y = 0; y < texture.height; ++y)
        setTexel(texture, 0, y, colours[y]);
    return texture;
}

Texture makeLeadedGlass()
{
    constexpr uint32_t panes = 16, paneTexels = 8;
    constexpr glm::vec3 lead(0.004f);
    constexpr glm::vec3 glass[] = {
        {1, 1, 1},         {1, 0.80f, 0.55f}, {0.55f, 0.80f, 1},    {1, 0.10f, 0.05f},
        {0.10f, 0.22f, 1}, {1, 0.55f, 0.06f}, {0.13f, 0.80f, 0.32f}};
    Texture texture = makeSrgb(panes * paneTexels, panes * paneTexels);
    Random random(0);
    for (uint32_t pane = 0; pane < panes * panes; ++pane) {
        const float brightness = random.uniform(0.25f, 1.0f);
        const glm::vec3 colour =
            brightness * glass[random.below(static_cast<uint32_t>(std::size(glass)))];
        for (uint32_t i = 0; i < paneTexels * paneTexels; ++i) {
            const uint32_t x = i % paneTexels, y = i / paneTexels;
            setTexel(texture, pane % panes * paneTexels + x, pane / panes * paneTexels + y,
                     x == 0 || y == 0 ? lead : colour);
        }
    }
    return texture;
}

} // namespace candelabra::app
