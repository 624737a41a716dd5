// SPDX-License-Identifier: Apache-2.0
// Random frames with any camera, size, depth convention and lights: clustered against brute force,
// and the kernels that GPUs run against those that llvmpipe runs. Sixty and twenty frames by
// default, 1,000 each with tools/test --full.
#include "gpu/gpu_like_device.h"
#include "gpu/lighting_harness.h"
#include "harness/full_tests.h"

#include <cmath>
#include <limits>
#include <random>

namespace candelabra::test
{
namespace
{

class RandomFrame
{
public:
    explicit RandomFrame(uint32_t seed) : random_(seed), seed_(seed) {}

    CpuGBuffer gbuffer()
    {
        const uint32_t width = 1 + uint32_t(uniform(0, 150)), height = 1 + uint32_t(uniform(0, 90));
        const double aspect = double(width) / height;
        CndCamera camera;
        const bool reversed = chance(0.7);
        const double near = std::pow(10, uniform(-3, 0));
        if (chance(0.2))
            setOrthographic(camera, uniform(1, 40), aspect, near, 100, reversed);
        else
            setPerspective(camera, uniform(0.02, 2.9), aspect, near, chance(0.5) ? 100 : 0,
                           reversed);
        return randomGBuffer(width, height, camera, reversed ? 0.0f : 1.0f, seed_);
    }
    std::vector<CndLight> lights(const CpuGBuffer& g)
    {
        auto lights = randomSpheres(g, uint32_t(std::pow(10, uniform(0, 3.3))), seed_);
        for (CndLight& light : lights) {
            // Some lights are tiny or huge, around the camera, or uncut.
            if (chance(0.1))
                light.radius *= float(std::pow(10, uniform(-4, 1)));
            light.influenceRadius = float(light.radius * std::pow(10, uniform(0.01, 2)));
            if (chance(0.02))
                light.influenceRadius = std::numeric_limits<float>::infinity();
            if (chance(0.02))
                light.position[0] = light.position[1] = light.position[2] = 0;
        }
        return lights;
    }

private:
    double uniform(double low, double high)
    {
        return low + (high - low) * double(random_()) / 4294967296.0;
    }
    bool chance(double p) { return uniform(0, 1) < p; }

    std::mt19937 random_;
    uint32_t seed_;
};

} // namespace

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
