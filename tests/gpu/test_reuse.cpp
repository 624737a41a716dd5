// SPDX-License-Identifier: Apache-2.0
// Work that a frame does not need is skipped, and the image is unaffected.
#include "gpu/lighting_harness.h"

#include <algorithm>

namespace candelabra::test
{
namespace
{

bool ran(const CndLightingStats& stats, const char* kernel)
{
    return std::any_of(stats.kernelTimes, stats.kernelTimes + stats.kernelTimeCount,
                       [&](const CndKernelTime& t) { return std::string(t.name) == kernel; });
}

// Returns why the frame skipped a pass; empty if it ran.
std::string skipped(const CndLightingStats& stats, const char* pass)
{
    const CndPassPlan* end = stats.passes + stats.passCount;
    const CndPassPlan* p = std::find_if(
        stats.passes, end, [&](const CndPassPlan& x) { return std::string(x.name) == pass; });
    if (p == end)
        return "not a pass";
    return p->skipped ? p->skipped : "";
}

// A pass that ran according to the plan has a time, and every pass with a time is in the plan.
void expectPlanOfWhatRan(const CndLightingStats& stats)
{
    for (uint32_t i = 0; i < stats.passCount; ++i)
        EXPECT_TRUE(stats.passes[i].skipped || ran(stats, stats.passes[i].name))
            << stats.passes[i].name;
    for (uint32_t i = 0; i < stats.kernelTimeCount; ++i)
        EXPECT_NE(skipped(stats, stats.kernelTimes[i].name), "not a pass")
            << stats.kernelTimes[i].name;
}

CpuGBuffer surfaces(uint32_t seed)
{
    return randomGBuffer(120, 80, seed);
}

} // namespace

TEST_F(LightingTest, UnchangedFramesKeepTheirLists)
{
    const CpuGBuffer g = surfaces(3);
    std::vector<CndLight> lights = randomSpheres(g, 400, 5);
    for (size_t i = 0; i < lights.size(); i += 3)
        lights[i].type = CND_LIGHT_POINT; // lists of more than one type
    // With the small budget some clusters have no lists.
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
        for (const LightingResult* result : {&fresh, &kept})
            expectPlanOfWhatRan(result->stats);
        EXPECT_EQ(skipped(kept.stats, "prepare_lights"), "surfaces and lights unchanged");
        EXPECT_EQ(skipped(kept.stats, "cluster_lists"), "surfaces and lights unchanged");
        EXPECT_EQ(skipped(kept.stats, "light_order"), "lights unchanged");
        EXPECT_EQ(skipped(kept.stats, "shade_unlisted"),
                  budget ? "" : "every cluster has its list");
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
    const auto own = createLighting(g, 1);
    for (const uint32_t seed : {1u, 2u}) {
        const auto lights = randomSpheres(g, 100, seed);
        setLights(own.lighting, lights);
        CndLightingFrame frame = frameOf(g, images, {});
        frame.surfacesUnchanged = true;
        EXPECT_TRUE(sameBits(drawFrame(own.view, frame, images), run(g, lights).radiance)) << seed;
    }
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
    for (const char* pass : {"split_tiles", "shade_tiles", "count_pairs"})
        EXPECT_EQ(skipped(empty.stats, pass), "no surface") << pass;

    const LightingResult dark = run(surfaces(5), {});
    EXPECT_EQ(dark.stats.kernelTimeCount, 0u);
    for (uint32_t i = 0; i < dark.stats.passCount; ++i)
        EXPECT_STREQ(dark.stats.passes[i].skipped, "no lights") << dark.stats.passes[i].name;

    // Lights that reach everything need no lists.
    CndLight sun{.type = CND_LIGHT_DIRECTIONAL, .direction = {0, 0, -1}, .emission = {1, 1, 1}};
    const LightingResult sunny = run(surfaces(5), {sun});
    EXPECT_TRUE(ran(sunny.stats, "shade_tiles"));
    EXPECT_FALSE(ran(sunny.stats, "cluster_lists"));
    EXPECT_FALSE(ran(sunny.stats, "light_tree"));
    EXPECT_EQ(sunny.stats.lightTypeCounts[CND_LIGHT_DIRECTIONAL], 1u);
    for (const char* pass : {"split_tiles", "block_clusters", "light_tree", "cluster_lists"})
        EXPECT_EQ(skipped(sunny.stats, pass), "distant lights only") << pass;
    expectPlanOfWhatRan(sunny.stats);
    const LightingResult brute = run(surfaces(5), {sun}, {.culling = CND_CULLING_BRUTE});
    EXPECT_TRUE(agree(sunny.radiance, brute.radiance));
    EXPECT_EQ(skipped(brute.stats, "shade_tiles"), "brute force");
    expectPlanOfWhatRan(brute.stats);
}

// Light types of which no light reaches the view are skipped, and tiles without lights are not
// shaded.
TEST_F(LightingTest, WhatIsLitIsAllThatIsShaded)
{
    const CpuGBuffer g = surfaces(6);
    std::vector<CndLight> lights = randomSpheres(g, 60, 7);
    std::vector<CndLight> behind = lights;
    for (CndLight& light : behind)
        light.position[2] = 1000; // metres; the view looks along -z
    const LightingResult none = run(g, behind, {.countPairs = true});
    for (const char* pass : {"prepare_lights", "tile_clusters", "cluster_lists", "shade_tiles"})
        EXPECT_EQ(skipped(none.stats, pass), "no light reaches the view") << pass;
    EXPECT_EQ(skipped(none.stats, "light_order"), ""); // runs once per set, whatever is in view
    EXPECT_EQ(none.stats.kernelTimeCount, 1u);
    EXPECT_TRUE(sameBits(none, run(g, behind, {.culling = CND_CULLING_BRUTE})));

    // One type is in view, one is behind it: the image is the same as without the lights behind.
    std::vector<CndLight> both = lights;
    for (CndLight light : behind) {
        light.type = CND_LIGHT_POINT;
        both.push_back(light);
    }
    const LightingResult half = run(g, both), alone = run(g, lights);
    EXPECT_LE(maxRelativeDifference(half.radiance, alone.radiance), 1e-6); // the order may differ
    EXPECT_EQ(half.stats.lightTypeCounts[CND_LIGHT_POINT], 60u);

    // The light is in the view but reaches no surface: lists are made, and are empty.
    std::vector<CndLight> inTheAir = randomSpheres(g, 1, 3);
    inTheAir[0].position[0] = inTheAir[0].position[1] = 0;
    inTheAir[0].position[2] = -0.2f;
    inTheAir[0].radius = 0.001f;
    inTheAir[0].influenceRadius = 0.01f;
    const LightingResult air = run(g, inTheAir);
    EXPECT_EQ(air.stats.listEntries, 0u);
    EXPECT_GT(air.stats.tileCount, 0u);
    EXPECT_EQ(skipped(air.stats, "shade_tiles"), "every list is empty");
    for (const glm::vec4& v : air.radiance)
        ASSERT_EQ(v, glm::vec4(0));
}

} // namespace candelabra::test
