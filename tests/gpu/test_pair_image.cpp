// SPDX-License-Identifier: Apache-2.0
// The pair image must hold, pixel by pixel, what the statistics sum up.
#include "gpu/lighting_harness.h"

namespace candelabra::test
{

TEST_F(LightingTest, PairImageSumsToTheStatistics)
{
    const CpuGBuffer g = randomGBuffer(120, 80, 8);
    std::vector<CndLight> lights = randomSpheres(g, 400, 5);
    for (size_t i = 0; i < lights.size(); i += 3)
        lights[i].type = CND_LIGHT_POINT; // the counts of two types are added
    const Images images = uploadImages(g), pairs = uploadImages(g);
    const auto own = createLighting(g, 1);
    setLights(own.lighting, lights);
    CndLightingFrame frame = frameOf(g, images, {.countPairs = true});
    frame.pairImage = pairs.radiance.view.get();
    context().submitAndWait([&](VkCommandBuffer cmd) { clearRadiance(cmd, pairs); });
    drawFrame(own.view, frame, images);
    const CndLightingStats stats = statsOf(own.view);
    const std::vector<glm::vec4> counted = readRadiance(pairs);
    glm::dvec3 sum(0);
    int ofClass[4] = {};
    for (size_t i = 0; i < counted.size(); ++i) {
        sum += glm::dvec3(counted[i]);
        const bool surface = g.depth[i] != g.clearDepth;
        ASSERT_EQ(counted[i].w > 0, surface) << i;
        ASSERT_LE(counted[i].z, counted[i].x) << i; // contributing lights are among the listed ones
        ++ofClass[size_t(counted[i].w)];
    }
    EXPECT_EQ(uint64_t(sum.x), stats.listedPairs);
    // The statistics also count lanes without a surface that wait for others of their tile.
    EXPECT_LE(uint64_t(sum.y), stats.evaluatedPairs);
    EXPECT_GE(sum.y, sum.z);
    EXPECT_EQ(uint64_t(sum.z), stats.contributingPairs);
    EXPECT_GT(ofClass[CND_PIXEL_OF_SLICE], 0);
    EXPECT_LE(ofClass[CND_PIXEL_OF_SLICE], int(64 * stats.splitTileCount));
    EXPECT_EQ(ofClass[CND_PIXEL_UNLISTED], 0);
}

} // namespace candelabra::test
