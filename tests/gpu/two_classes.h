// SPDX-License-Identifier: Apache-2.0
// Surfaces of which some lack the specular lobe, for tests of CndLightingDesc::diffuseOnlyTiles.
#pragma once

#include "gpu/lighting_harness.h"

namespace candelabra::test
{

// The left third of the tiles has no specular lobe, but in the second row every tile has one pixel
// with both lobes.
inline CpuGBuffer twoClasses(uint32_t width, uint32_t height)
{
    constexpr uint32_t tile = 8;
    CpuGBuffer g = randomGBuffer(width, height, 11);
    for (uint32_t y = 0; y < height; ++y)
        for (uint32_t x = 0; x < width; ++x) {
            const size_t i = y * width + x;
            const bool odd = y / tile == 1 && y % tile == 5 && x % tile == 3;
            const bool diffuse = 3 * (x / tile) < width / tile && !odd;
            const glm::dvec3 colour(0.2 + 0.01 * double(i % 50), 0.5, 0.7);
            if (y / tile == 1) // a hole would show the background, which has no class
                g.depth[i] = depthAt(g.camera, 4);
            g.albedo[i] = packAlbedo(colour);
            g.specular[i] = packSpecular(diffuse ? glm::dvec4(0) : glm::dvec4(0.5 * colour, 1));
        }
    return g;
}

} // namespace candelabra::test
