// SPDX-License-Identifier: Apache-2.0
#include "scene/shadow_casters.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace candelabra::app
{
namespace
{

// Returns the texel of a row of `size` texels that shows the coordinate x.
uint32_t texelAt(float x, uint32_t size, bool repeat, bool mirror)
{
    if (mirror)
        x = 1 - std::abs(x - 2 * std::floor(0.5f * x) - 1);
    else if (repeat)
        x -= std::floor(x);
    return uint32_t(std::clamp(x * float(size), 0.0f, float(size - 1)));
}

float alphaAt(const Texture& texture, const TextureRef& ref, const glm::vec2& uv)
{
    const float u = glm::dot(ref.uRow, glm::vec3(uv, 1)), v = glm::dot(ref.vRow, glm::vec3(uv, 1));
    const size_t x = texelAt(u, texture.width, texture.repeatU, texture.mirrorU);
    const size_t y = texelAt(v, texture.height, texture.repeatV, texture.mirrorV);
    return float(texture.rgba[4 * (y * texture.width + x) + 3]) / 255;
}

// Tells whether a masked triangle is there on at least half of its area, by points that are spread
// over it.
bool isMostlyThere(const Scene& scene, const Material& material, const Mesh& mesh, size_t triangle)
{
    constexpr int rows = 8;
    const TextureRef& ref = material.baseColorTexture;
    const Vertex* corners[3];
    for (size_t i = 0; i < 3; ++i)
        corners[i] = &mesh.vertices[mesh.indices[3 * triangle + i]];
    int there = 0, all = 0;
    for (int i = 0; i < rows; ++i)
        for (int j = 0; i + j < rows; ++j) {
            const float b = (float(i) + 1 / 3.0f) / rows, c = (float(j) + 1 / 3.0f) / rows;
            const auto mix = [&](auto of) {
                return of(*corners[0]) * (1 - b - c) + of(*corners[1]) * b + of(*corners[2]) * c;
            };
            float alpha = material.alpha * mix([](const Vertex& v) { return v.color.a; });
            if (ref.texture >= 0)
                alpha *= alphaAt(scene.textures[size_t(ref.texture)], ref,
                                 mix([&](const Vertex& v) { return v.uv[ref.uvSet]; }));
            there += alpha >= material.alphaCutoff;
            ++all;
        }
    return 2 * there >= all;
}

} // namespace

bool castsShadow(const Scene& scene, const Material& material, const Mesh& mesh, size_t triangle)
{
    return material.alphaMode == AlphaMode::Opaque ||
           (material.alphaMode == AlphaMode::Mask &&
            isMostlyThere(scene, material, mesh, triangle));
}

std::vector<std::string> inexactShadows(const Scene& scene)
{
    size_t blended = 0, masked = 0;
    for (const Instance& instance : scene.instances) {
        const AlphaMode mode = scene.materials[instance.material].alphaMode;
        blended += mode == AlphaMode::Blend;
        masked += mode == AlphaMode::Mask;
    }
    std::vector<std::string> out;
    const size_t all = scene.instances.size();
    if (blended)
        out.push_back(fmt::format("{}: {} of {} objects are blended or transmissive, and cast no "
                                  "shadows",
                                  scene.name, blended, all));
    if (masked)
        out.push_back(fmt::format("{}: {} of {} objects are masked: each of their triangles casts "
                                  "a whole shadow if at least half of it is there, and none "
                                  "otherwise",
                                  scene.name, masked, all));
    return out;
}

} // namespace candelabra::app
