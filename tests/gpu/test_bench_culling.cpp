// SPDX-License-Identifier: Apache-2.0
// The benchmark of culling at a small size. Every way to cull must give the image of brute force,
// otherwise comparing their times would be meaningless.
#include "harness/gpu_fixture.h"
#include "harness/json_keys.h"
#include "load/load.h"
#include "measure/culling/culling.h"
#include "shared/raster.h"

using namespace candelabra;
using namespace candelabra::app;

namespace
{

class BenchCulling : public test::GpuTest
{
};

} // namespace

TEST_F(BenchCulling, EveryWayGivesTheImageOfBruteForce)
{
    CullingSettings settings{.sizes = {{200, 120}}, .lights = {300}, .overlaps = {8}, .rounds = 1};
    // The instances of the field do not fit in a texel buffer of Vulkan's guaranteed 65,536 texels.
    if (loadScene("field", {.lights = 1}).instances.size() * gpu::INSTANCE_TEXELS >
        device().limits.maxTexelBufferElements)
        std::erase(settings.scenes, "field");
    const std::vector<CullingPoint> points = measureCulling(context(), settings, false);
    ASSERT_EQ(points.size(), settings.scenes.size());
    ASSERT_GE(points.size(), 2u);
    for (const CullingPoint& p : points) {
        const Contender& engine = p.of(engineName);
        for (const char* name : {engineName, tilesName, froxelsName, bruteName}) {
            const Contender& c = p.of(name);
            ASSERT_FALSE(c.skippedMs);
            ASSERT_TRUE(c.difference) << name;
            std::cout << p.scene << ", " << name << ": " << *c.difference << ", "
                      << c.stats.listedPairs << " listed for " << c.stats.contributingPairs << "\n";
            EXPECT_LE(*c.difference, 1e-6) << p.scene << " " << name;
            EXPECT_EQ(c.times.frames(), 1u) << name;
            if (name == bruteName)
                continue;
            // All ways find the same contributing lights, even if their lists hold more lights.
            EXPECT_EQ(c.stats.contributingPairs, engine.stats.contributingPairs)
                << p.scene << " " << name;
            EXPECT_EQ(c.stats.insidePairs >= c.stats.contributingPairs, true) << name;
            EXPECT_GE(c.stats.listedPairs, c.stats.insidePairs) << name;
            EXPECT_GT(c.stats.listEntries, 0u) << name;
        }
        EXPECT_LE(engine.stats.listedPairs, p.of(tilesName).stats.listedPairs) << p.scene;
        EXPECT_GT(p.of(floorName).totalMs(), 0) << p.scene;
    }
    EXPECT_EQ(cullingFailures(points).size(), 0u);
    const auto json = nlohmann::json::parse(cullingJson(settings, points).dump());
    EXPECT_EQ(json["points"].size(), points.size());
    EXPECT_EQ(test::keyFaults(json["points"], "bench-culling-points"), "");
    EXPECT_EQ(cullingPlots(points, context().info()).size(), points.size());
    EXPECT_NE(textOf(cullingTables(points)).find("200x120"), std::string::npos);
}

// More lights than one loop may test on llvmpipe; other devices need no batches.
TEST_F(BenchCulling, EveryWayFindsAllOfManyLights)
{
    const CullingSettings settings{.scenes = {"hall"},
                                   .sizes = {{96, 64}},
                                   .lights = {70000},
                                   .overlaps = {8},
                                   .rounds = 1,
                                   .bruteLimit = 0};
    const std::vector<CullingPoint> points = measureCulling(context(), settings, false);
    ASSERT_EQ(points.size(), 1u);
    EXPECT_TRUE(cullingFailures(points).empty());
    const Contender& engine = points[0].of(engineName);
    for (const char* name : {tilesName, froxelsName}) {
        const Contender& c = points[0].of(name);
        EXPECT_LE(c.difference.value_or(1), Contender::reorderedBound) << name;
        EXPECT_EQ(c.stats.contributingPairs, engine.stats.contributingPairs) << name;
    }

    // A baseline that draws another image does not count.
    CullingPoint point = points[0];
    const std::string best = point.bestBaseline().name;
    for (Contender& c : point.contenders)
        if (c.name == best)
            c.difference = 0.1;
    EXPECT_NE(point.bestBaseline().name, best);
    EXPECT_EQ(cullingFailures({point}).size(), 1u);
    // Brute force sums in the engine's order, so its bound is tighter.
    Contender brute{.name = bruteName, .difference = 2e-6};
    EXPECT_FALSE(brute.hasRightImage());
}

TEST_F(BenchCulling, BruteForceOverTheLimitIsListedWithItsEstimate)
{
    const CullingSettings settings{.scenes = {"fence"},
                                   .sizes = {{64, 48}},
                                   .lights = {200},
                                   .overlaps = {8, 100000},
                                   .rounds = 1,
                                   .bruteLimit = 0};
    const std::vector<CullingPoint> points = measureCulling(context(), settings, false);
    ASSERT_EQ(points.size(), 1u); // this many overlaps are impossible
    EXPECT_GT(points[0].of(bruteName).skippedMs.value_or(0), 0);
    const std::string text = textOf(cullingTables(points));
    EXPECT_NE(text.find("skipped (about"), std::string::npos) << text;
    EXPECT_NE(text.find("--brute-limit 1 draws all"), std::string::npos) << text;
    const auto json = nlohmann::json::parse(cullingJson(settings, points).dump());
    EXPECT_EQ(json["shadows"], "off");
    const auto brute = json["points"][0]["contenders"][3];
    EXPECT_EQ(brute["skipped"], true);
    EXPECT_GT(brute["estimatedMs"].get<double>(), 0);
}

TEST_F(BenchCulling, TheFrameWithShadowsIsOneMore)
{
    const CullingSettings settings{.scenes = {"fence"},
                                   .sizes = {{64, 48}},
                                   .lights = {200},
                                   .overlaps = {8},
                                   .rounds = 2,
                                   .shadows = 32,
                                   .bruteLimit = 0};
    const std::vector<CullingPoint> points = measureCulling(context(), settings, false);
    const Contender& shadowed = points.at(0).of(shadowedName);
    EXPECT_EQ(shadowed.times.frames(), 2u);
    EXPECT_GT(shadowed.shadingMs(), points[0].of(engineName).shadingMs());
    EXPECT_EQ(shadowed.stats.listedPairs, points[0].of(engineName).stats.listedPairs);
    EXPECT_FALSE(shadowed.difference);
    EXPECT_TRUE(cullingFailures(points).empty()); // the other ways have the unshadowed image
    EXPECT_EQ(cullingJson(settings, points)["shadows"], "32");
    EXPECT_NE(textOf(cullingTables(points)).find(shadowedName), std::string::npos);
}
