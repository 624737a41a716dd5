// SPDX-License-Identifier: Apache-2.0
// What a frame does not need is not done, and leaves the image as it was.
#include "gpu/lighting_harness.h"

#include <algorithm>
#include <cstring>

namespace candelabra::test
{
namespace
{

bool ran(const CndLightingStats& stats, const char* kernel)
{
    return std::any_of(stats.kernelTimes, stats.kernelTimes + stats.kernelTimeCount,
                       [&](const CndKernelTime& t) { return std::string(t.name) == kernel; });
}

bool sameBits(const LightingResult& a, const LightingResult& b)
{
    return a.radiance.size() == b.radiance.size() &&
           std::memcmp(a.radiance.data(), b.radiance.data(),
                       a.radiance.size() * sizeof a.radiance[0]) == 0;
}

CpuGBuffer surfaces(uint32_t seed)
{
    CndCamera camera;
    setPerspective(camera, 1.0, 1.5, 0.1);
    return randomGBuffer(120, 80, camera, 0, seed);
}

} // namespace

TEST_F(LightingTest, UnchangedFramesKeepTheirLists)
{
    const CpuGBuffer g = surfaces(3);
    std::vector<CndLight> lights = randomSpheres(g, 400, 5);
    for (size_t i = 0; i < lights.size(); i += 3)
        lights[i].type = CND_LIGHT_POINT; // lists of more than one type
    // The small budget has clusters without lists as well.
    for (const VkDeviceSize budget : {VkDeviceSize(0), VkDeviceSize(20000)}) {
        const LightingResult fresh = run(g, lights, {.listBudget = budget, .countPairs = true});
        const LightingResult kept = run(
            g, lights, {.listBudget = budget, .countPairs = true, .frames = 3, .unchanged = true});
        EXPECT_TRUE(sameBits(fresh, kept));
        EXPECT_EQ(fresh.stats.unlistedClusters > 0, budget > 0);
        for (const char* kernel : {"prepare_lights", "tile_clusters", "split_tiles",
                                   "block_clusters", "light_tree", "cluster_lists"}) {
            EXPECT_TRUE(ran(fresh.stats, kernel)) << kernel;
            EXPECT_FALSE(ran(kept.stats, kernel)) << kernel;
        }
        EXPECT_EQ(fresh.stats.tileCount, kept.stats.tileCount);
        EXPECT_EQ(fresh.stats.unlistedClusters > 0, kept.stats.unlistedClusters > 0);
        if (!budget) {
            EXPECT_EQ(fresh.stats.listEntries, kept.stats.listEntries);
            EXPECT_EQ(fresh.stats.contributingPairs, kept.stats.contributingPairs);
        }
    }
}

TEST_F(LightingTest, ChangedLightsAreListedAgainDespiteThePromise)
{
    const CpuGBuffer g = surfaces(4);
    const Images images = uploadImages(g);
    CndError error{};
    const auto [lighting, view] = createLighting(g, 1);
    ASSERT_TRUE(lighting && view);
    for (const uint32_t seed : {1u, 2u}) {
        const auto lights = randomSpheres(g, 100, seed);
        const CndLightSet set{sizeof set, uint32_t(lights.size()), lights.data(), {}};
        ASSERT_EQ(cndSetLights(lighting, &set, &error), CND_SUCCESS) << error.message;
        CndLightingFrame frame = frameOf(g, images, {});
        frame.surfacesUnchanged = true;
        context().submitAndWait([&](VkCommandBuffer cmd) {
            clearRadiance(cmd, images);
            EXPECT_EQ(cndRecordLighting(view, cmd, &frame, &error), CND_SUCCESS) << error.message;
        });
        LightingResult result;
        result.radiance = readRadiance(images);
        EXPECT_TRUE(sameBits(result, run(g, lights))) << seed;
    }
    cndDestroyLightingView(view);
    cndDestroyLighting(lighting);
}

TEST_F(LightingTest, FramesWithoutSurfacesOrLightsShadeNothing)
{
    CpuGBuffer sky = surfaces(5);
    std::fill(sky.depth.begin(), sky.depth.end(), sky.clearDepth);
    const LightingResult empty = run(sky, randomSpheres(surfaces(5), 300, 1), {.countPairs = true});
    EXPECT_EQ(empty.stats.tileCount, 0u);
    EXPECT_EQ(empty.stats.listEntries, 0u);
    EXPECT_EQ(empty.stats.listedPairs, 0u);
    for (const glm::vec4& v : empty.radiance)
        ASSERT_EQ(v, glm::vec4(0));

    const LightingResult dark = run(surfaces(5), {});
    EXPECT_EQ(dark.stats.kernelTimeCount, 0u);

    // Lights that reach everything need no clusters' lists.
    CndLight sun{.type = CND_LIGHT_DIRECTIONAL, .direction = {0, 0, -1}, .emission = {1, 1, 1}};
    const LightingResult sunny = run(surfaces(5), {sun});
    EXPECT_TRUE(ran(sunny.stats, "shade_tiles"));
    EXPECT_FALSE(ran(sunny.stats, "cluster_lists"));
    EXPECT_FALSE(ran(sunny.stats, "light_tree"));
}

} // namespace candelabra::test
