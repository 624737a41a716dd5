// SPDX-License-Identifier: Apache-2.0
// Surfaces of which some lack a lobe, for tests of CndMaterialClass.
#pragma once

#include <glm/gtc/packing.hpp>

#include "gpu/lighting_harness.h"

namespace candelabra::test
{

inline glm::uvec2 half4(const glm::vec4& v)
{
    return {glm::packHalf2x16({v.x, v.y}), glm::packHalf2x16({v.z, v.w})};
}

// Returns columns of tiles, from the left: without a specular lobe, without a diffuse lobe, with
// both. In the second row every tile has one pixel with both lobes.
inline CpuGBuffer threeClasses(uint32_t width, uint32_t height)
{
    constexpr uint32_t tile = 8;
    CpuGBuffer g = randomGBuffer(width, height, 11);
    for (uint32_t y = 0; y < height; ++y)
        for (uint32_t x = 0; x < width; ++x) {
            const size_t i = y * width + x;
            const bool odd = y / tile == 1 && y % tile == 5 && x % tile == 3;
            const uint32_t third = 3 * (x / tile) / (width / tile);
            const glm::vec3 colour(0.2 + 0.01 * double(i % 50), 0.5, 0.7);
            if (y / tile == 1) // a hole would show the background, which has no class
                g.depth[i] = depthAt(g.camera, 4);
            g.albedo[i] = half4(glm::vec4(third == 1 && !odd ? glm::vec3(0) : colour, 0));
            g.specular[i] = half4(third == 0 && !odd ? glm::vec4(0) : glm::vec4(0.5f * colour, 1));
        }
    return g;
}

} // namespace candelabra::test
