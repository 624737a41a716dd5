// SPDX-License-Identifier: Apache-2.0
// Tests that bench lanes counts what the engine does: its sums are those of the engine's
// statistics.
#include "harness/gpu_fixture.h"
#include "harness/json_schema.h"
#include "load/load.h"
#include "measure/frame/frames.h"
#include "measure/lanes/lane_counter.h"
#include "measure/lanes/lanes.h"
#include "render/camera.h"
#include "render/renderer.h"

using namespace candelabra;

namespace
{

class BenchLanes : public test::GpuTest
{
};

} // namespace

TEST_F(BenchLanes, CountsThePairsOfTheStatistics)
{
    const app::VulkanContext counting({.device = std::to_string(context().info().index),
                                       .validation = app::Validation::On,
                                       .engineFunctions = app::LaneCounter::functions});
    const app::LaneSettings settings{.scenes = {"fence"}, .lights = {300}, .size = {200, 120}};
    app::Progress progress(1, false);
    const auto points = app::measureLanes(counting, settings, progress);
    ASSERT_EQ(points.size(), 1u);
    for (const app::ValidationMessage& message : counting.instance().messages().take())
        ADD_FAILURE() << message.id << ": " << message.text;

    const app::Scene scene = app::loadScene("fence", {.lights = 300, .seed = 1, .overlaps = 8});
    app::Renderer renderer(context(), scene,
                           {.size = settings.size, .specularMethods = 1u << CND_SPECULAR_CONIC});
    app::FrameOptions options{.camera = app::selectCamera(scene, ""), .lightsVisible = false};
    cndDefaultExposureSettings(&options.exposure);
    const CndLightingStats stats = app::countPairs(context(), renderer, options);
    const app::LanePhase& shading = points[0].phases[gpu::LANES_OF_SHADING];
    EXPECT_EQ(shading.loops[0].turns, stats.listedPairs);
    uint64_t evaluated = 0;
    for (size_t loop = 1; loop < gpu::LANE_LOOPS; ++loop)
        evaluated += shading.loops[loop].turns;
    EXPECT_EQ(evaluated, stats.contributingPairs);
    EXPECT_GT(stats.contributingPairs, 0u);
    EXPECT_GT(shading.loops[3].turns, 0u);
    EXPECT_GE(shading.longestLane, stats.maxListLength);
    EXPECT_GT(shading.efficiency(0), shading.efficiency(1));
    EXPECT_GT(shading.efficiency(1), shading.efficiency(2));
    EXPECT_GT(shading.efficiency(2), 0);
    // Every light of a list has been tested for it.
    const app::LanePhase& tiles = points[0].phases[gpu::LANES_OF_TILE_LISTS];
    const app::LanePhase& slices = points[0].phases[gpu::LANES_OF_SLICE_LISTS];
    EXPECT_GE(tiles.loops[0].turns + slices.loops[0].turns, stats.listEntries);
    EXPECT_GT(slices.loops[0].turns, 0u);

    const app::Json json = app::laneJson(settings, points);
    EXPECT_EQ(test::schemaFaults(json["points"], "bench_lanes.schema.json", "#/properties/points"),
              "");
    EXPECT_NE(app::laneTable(points).find("fence, 300, shade_tiles"), std::string::npos);
}
