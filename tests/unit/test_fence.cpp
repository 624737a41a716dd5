// SPDX-License-Identifier: Apache-2.0
// Tests the generated scene of depth discontinuities.
#include <gtest/gtest.h>

#include "generate/generators.h"
#include "generate/ray_caster.h"
#include "scene/scene_options.h"

namespace candelabra::app
{

// The purpose of the scene: most tiles of 16x16 pixels see objects that are metres apart.
TEST(Fence, TilesHoldSeveralDepths)
{
    const Scene scene = generateFence({.lights = 0});
    const Camera& camera = scene.cameras[0];
    RayCaster caster(scene);
    constexpr uint32_t columns = 160, rows = 90; // for 1280x720: 8 pixels apart, 2x2 per tile
    std::vector<double> depth(columns * rows, 0);
    size_t hits = 0;
    for (uint32_t y = 0; y < rows; ++y)
        for (uint32_t x = 0; x < columns; ++x)
            if (const auto hit = caster.cast(cameraRay(camera, x, y, columns, rows))) {
                depth[y * columns + x] = glm::dot(hit->position - camera.position, camera.forward);
                ++hits;
            }
    EXPECT_GT(hits, size_t(columns * rows * 3 / 4));
    size_t deep = 0;
    for (uint32_t y = 0; y + 1 < rows; y += 2)
        for (uint32_t x = 0; x + 1 < columns; x += 2) {
            const double a = depth[y * columns + x], b = depth[y * columns + x + 1],
                         c = depth[(y + 1) * columns + x], d = depth[(y + 1) * columns + x + 1];
            deep += std::max({a, b, c, d}) - std::min({a, b, c, d}) > 2;
        }
    std::cout << deep << " of " << columns * rows / 4 << " tiles hold depths 2 m apart\n";
    EXPECT_GT(deep, size_t(columns * rows / 4 / 3));
}

} // namespace candelabra::app
