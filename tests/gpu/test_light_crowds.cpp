// SPDX-License-Identifier: Apache-2.0
// Lights where they hurt most: a crowd within one pixel, all of them over the whole screen, and
// lists without enough room.
#include "gpu/lighting_harness.h"

#include <limits>
#include <random>

namespace candelabra::test
{
namespace
{

constexpr VkDeviceSize megabyte = 1u << 20;

CpuGBuffer surfaces(uint32_t width, uint32_t height)
{
    return randomGBuffer(width, height, 21);
}

} // namespace

TEST_F(LightingTest, AHundredThousandLightsInOnePixel)
{
    const CpuGBuffer g = surfaces(40, 24);
    size_t pixel = g.depth.size() / 2;
    while (g.depth[pixel] == g.clearDepth)
        ++pixel;
    const glm::dvec3 p = viewPosition(g, uint32_t(pixel % g.width), uint32_t(pixel / g.width)) +
                         0.05 * storedNormal(g, pixel);
    std::mt19937 random(7);
    std::uniform_real_distribution<double> near(-0.004, 0.004);
    std::vector<CndLight> lights = randomSpheres(g, 1, 3);
    lights[0].radius = 0.001f;
    lights[0].influenceRadius = 0.3f;
    lights.resize(100000, lights[0]);
    for (CndLight& light : lights)
        for (int i = 0; i < 3; ++i)
            light.position[i] = float(p[i] + near(random));
    const LightingResult brute = run(g, lights, {.culling = CND_CULLING_BRUTE});
    EXPECT_GT(brute.radiance[pixel].x + brute.radiance[pixel].y + brute.radiance[pixel].z, 0);
    // The list of all lights takes 400 kB, so a quarter of a megabyte has no room for it.
    for (const VkDeviceSize budget : {VkDeviceSize(0), megabyte / 4}) {
        const LightingResult clustered = run(g, lights, {.listBudget = budget});
        EXPECT_TRUE(agree(clustered.radiance, brute.radiance, batchesOnLlvmpipe)) << budget;
        if (budget) {
            EXPECT_GT(clustered.stats.unlistedClusters, 0u);
        }
    }
}

TEST_F(LightingTest, AThousandLightsOverTheWholeScreen)
{
    const CpuGBuffer g = surfaces(200, 120);
    std::vector<CndLight> lights = randomSpheres(g, 1000, 8);
    for (size_t i = 0; i < lights.size(); ++i)
        lights[i].influenceRadius = i % 2 ? 1000 : std::numeric_limits<float>::infinity();
    const LightingResult brute = run(g, lights, {.culling = CND_CULLING_BRUTE});
    for (const VkDeviceSize budget : {VkDeviceSize(0), megabyte}) {
        const LightingResult clustered = run(g, lights, {.listBudget = budget});
        EXPECT_TRUE(agree(clustered.radiance, brute.radiance, batchesOnLlvmpipe)) << budget;
        EXPECT_EQ(clustered.stats.unlistedClusters > 0, budget > 0);
    }
}

} // namespace candelabra::test
