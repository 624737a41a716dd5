// SPDX-License-Identifier: Apache-2.0
// Random frames with any camera, size, depth convention and lights: clustered against brute force,
// and the kernels that GPUs run against those that llvmpipe runs. Sixty and twenty frames by
// default, 1,000 each with tools/test --full.
#include "gpu/gpu_like_device.h"
#include "gpu/lighting_harness.h"
#include "gpu/random_frame.h"
#include "harness/full_tests.h"

namespace candelabra::test
{
TEST_F(LightingTest, RandomFramesEqualBrute)
{
    const uint32_t frames = fullTests() ? 1000 : 60;
    uint32_t lit = 0;
    for (uint32_t seed = 0; seed < frames; ++seed) {
        RandomFrame frame(seed);
        const CpuGBuffer g = frame.gbuffer();
        const auto lights = frame.lights(g);
        const LightingResult brute = run(g, lights, {.culling = CND_CULLING_BRUTE});
        const LightingResult clustered = run(g, lights);
        EXPECT_TRUE(agree(clustered.radiance, brute.radiance, batchesOnLlvmpipe))
            << "seed " << seed << ", " << g.width << "x" << g.height << ", " << lights.size()
            << " lights";
        for (const glm::vec4& v : brute.radiance)
            if (v.x > 0) {
                ++lit;
                break;
            }
    }
    EXPECT_GE(lit, frames / 2); // most frames have lit pixels to compare
}

// Clusters and lists are the same whether a group or a lane makes them.
TEST_F(LightingTest, RandomFramesHaveTheSameListsFromGroupsAndFromLanes)
{
    const uint32_t frames = fullTests() ? 1000 : 20;
    const CndDeviceDesc gpu = gpuLike(deviceDesc());
    RunOptions byGroups;
    byGroups.host = &gpu;
    byGroups.lighting = createFor(byGroups);
    uint64_t entries = 0, splits = 0;
    for (uint32_t seed = 0; seed < frames; ++seed) {
        RandomFrame frame(seed);
        const CpuGBuffer g = frame.gbuffer();
        const auto lights = frame.lights(g);
        const LightingResult expected = run(g, lights);
        const LightingResult got = run(g, lights, byGroups);
        EXPECT_TRUE(sameBits(got, expected)) << "seed " << seed;
        EXPECT_EQ(got.stats.listEntries, expected.stats.listEntries) << "seed " << seed;
        EXPECT_EQ(got.stats.maxListLength, expected.stats.maxListLength) << "seed " << seed;
        EXPECT_EQ(got.stats.splitTileCount, expected.stats.splitTileCount) << "seed " << seed;
        entries += expected.stats.listEntries;
        splits += expected.stats.splitTileCount;
    }
    cndDestroyLighting(byGroups.lighting);
    EXPECT_GT(entries, 100u * frames);
    EXPECT_GT(splits, frames);
}

} // namespace candelabra::test
