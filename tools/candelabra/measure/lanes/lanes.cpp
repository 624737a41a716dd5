// SPDX-License-Identifier: Apache-2.0
#include "measure/lanes/lanes.h"

#include <algorithm>
#include <tuple>

#include <fmt/format.h>

#include "io/table.h"
#include "load/load.h"
#include "measure/lanes/lane_counter.h"
#include "render/camera.h"
#include "render/renderer.h"

namespace candelabra::app
{
namespace
{

struct PhaseNames {
    const char* name;
    std::array<const char*, gpu::LANE_LOOPS> loops; // null: the phase does not have the loop
};

constexpr std::array<PhaseNames, gpu::LANE_PHASES> phaseNames{
    {{"cluster_lists, from the tree", {"light tests", "node tests"}},
     {"cluster_lists, blocks", {"light tests", "node tests"}},
     {"cluster_lists, tiles", {"light tests", "node tests"}},
     {"cluster_lists, slices", {"light tests", "node tests"}},
     {"shade_tiles", {"light tests", "above the horizon", "near it", "across it"}}}};

using Turns = std::array<uint64_t, gpu::LANE_LOOPS>;

Turns turnsOf(const gpu::LaneRound& round)
{
    return {round.turns01 & 0xffff, round.turns01 >> 16, round.turns23 & 0xffff,
            round.turns23 >> 16};
}

uint64_t sum(const Turns& turns)
{
    uint64_t out = 0;
    for (const uint64_t t : turns)
        out += t;
    return out;
}

// Adds the slots of subgroups of laneWidths[width] lanes. The rounds are sorted by phase, round and
// lane.
void addSlots(std::span<const gpu::LaneRound> rounds, size_t width, LanePhases& phases)
{
    const uint32_t lanes = laneWidths[width];
    // By phase and subgroup: turns of the subgroup.
    std::array<std::vector<Turns>, gpu::LANE_PHASES> waves;
    for (size_t i = 0; i < rounds.size();) {
        const uint32_t key = rounds[i].phaseRound, wave = rounds[i].lane / lanes;
        Turns most{};
        for (; i < rounds.size() && rounds[i].phaseRound == key && rounds[i].lane / lanes == wave;
             ++i)
            for (size_t loop = 0; loop < most.size(); ++loop)
                most[loop] = std::max(most[loop], turnsOf(rounds[i])[loop]);
        const uint32_t phase = key >> gpu::LANE_ROUND_BITS;
        if (waves[phase].size() <= wave)
            waves[phase].resize(wave + 1);
        for (size_t loop = 0; loop < most.size(); ++loop) {
            phases[phase].loops[loop].slots[width] += lanes * most[loop];
            waves[phase][wave][loop] += most[loop];
        }
    }
    if (lanes != 32)
        return;
    for (size_t phase = 0; phase < waves.size(); ++phase)
        for (const Turns& wave : waves[phase])
            if (sum(wave) > sum(phases[phase].longestWave))
                phases[phase].longestWave = wave;
}

LanePoint measurePoint(const VulkanContext& context, const LaneSettings& settings,
                       const std::string& name, uint32_t lights)
{
    const Scene scene =
        loadScene(name, {.lights = lights, .seed = settings.seed, .overlaps = settings.overlaps});
    FrameOptions options{.camera = selectCamera(scene, ""), .lightsVisible = false};
    cndDefaultExposureSettings(&options.exposure);
    LanePoint point{.scene = name, .lights = lights};
    LaneCounter counter(context);
    Renderer renderer(context, scene,
                      {.size = settings.size, .specularMethods = 1u << CND_SPECULAR_CONIC});
    const auto draw = [&] {
        context.submitAndWait([&](VkCommandBuffer cmd) { renderer.record(cmd, 0, options); });
    };
    counter.count(draw, [&](std::span<gpu::LaneRound> rounds) { addRounds(rounds, point.phases); });
    const CndLightingStats stats = renderer.lightingStats(0);
    point.tiles = stats.tileCount;
    point.splitTiles = stats.splitTileCount;
    point.unlistedClusters = stats.unlistedClusters;
    return point;
}

} // namespace

double LanePhase::efficiency(size_t width) const
{
    uint64_t turns = 0, slots = 0;
    for (const LaneLoop& loop : loops) {
        turns += loop.turns;
        slots += loop.slots[width];
    }
    return slots ? double(turns) / double(slots) : 0;
}

void addRounds(std::span<gpu::LaneRound> rounds, LanePhases& phases)
{
    std::sort(rounds.begin(), rounds.end(), [](const gpu::LaneRound& a, const gpu::LaneRound& b) {
        return std::tie(a.phaseRound, a.lane) < std::tie(b.phaseRound, b.lane);
    });
    std::array<std::vector<uint64_t>, gpu::LANE_PHASES> lanes; // turns by phase and lane
    for (const gpu::LaneRound& round : rounds) {
        const uint32_t phase = round.phaseRound >> gpu::LANE_ROUND_BITS;
        const Turns turns = turnsOf(round);
        for (size_t loop = 0; loop < turns.size(); ++loop)
            phases[phase].loops[loop].turns += turns[loop];
        if (lanes[phase].size() <= round.lane)
            lanes[phase].resize(round.lane + 1);
        lanes[phase][round.lane] += sum(turns);
    }
    for (size_t phase = 0; phase < lanes.size(); ++phase)
        for (const uint64_t turns : lanes[phase]) {
            phases[phase].lanes += turns > 0;
            phases[phase].longestLane = std::max(phases[phase].longestLane, turns);
        }
    for (size_t width = 0; width < laneWidths.size(); ++width)
        addSlots(rounds, width, phases);
}

std::vector<LanePoint> measureLanes(const VulkanContext& context, const LaneSettings& settings,
                                    Progress& progress)
{
    std::vector<LanePoint> points;
    for (const std::string& scene : settings.scenes)
        for (const uint32_t lights : settings.lights) {
            progress.doing(fmt::format("{}, {}", scene, counted(lights, "light")));
            points.push_back(measurePoint(context, settings, scene, lights));
            progress.advance(1);
        }
    return points;
}

uint64_t laneSteps(const LaneSettings& settings)
{
    return settings.scenes.size() * settings.lights.size();
}

std::string laneTable(const std::vector<LanePoint>& points)
{
    Table table({"scene, lights, dispatch", "turns (millions)", "efficiency at 8 lanes", "32", "64",
                 "longest lane"});
    for (const LanePoint& point : points)
        for (size_t i = 0; i < point.phases.size(); ++i) {
            const LanePhase& phase = point.phases[i];
            if (!phase.lanes)
                continue;
            uint64_t turns = 0;
            for (const LaneLoop& loop : phase.loops)
                turns += loop.turns;
            std::vector<std::string> row{
                fmt::format("{}, {}, {}", point.scene, grouped(point.lights), phaseNames[i].name),
                threeDigits(double(turns) * 1e-6)};
            for (size_t width = 0; width < laneWidths.size(); ++width)
                row.push_back(fmt::format("{:.0f}%", 100 * phase.efficiency(width)));
            row.push_back(grouped(phase.longestLane));
            table.add(row);
        }
    return table.text();
}

Json laneJson(const LaneSettings& settings, const std::vector<LanePoint>& points)
{
    Json out{{"widthPixels", settings.size.width},
             {"heightPixels", settings.size.height},
             {"overlaps", settings.overlaps},
             {"seed", settings.seed},
             {"specular", "conic"},
             {"points", Json::array()}};
    for (const LanePoint& point : points) {
        Json phases = Json::array();
        for (size_t i = 0; i < point.phases.size(); ++i) {
            const LanePhase& phase = point.phases[i];
            if (!phase.lanes)
                continue;
            Json loops = Json::array();
            for (size_t k = 0; k < phase.loops.size(); ++k)
                if (const char* name = phaseNames[i].loops[k]) {
                    const LaneLoop& loop = phase.loops[k];
                    loops.push_back({{"name", name},
                                     {"turns", loop.turns},
                                     {"slots8", loop.slots[0]},
                                     {"slots32", loop.slots[1]},
                                     {"slots64", loop.slots[2]},
                                     {"longestWave32", phase.longestWave[k]}});
                }
            phases.push_back({{"name", phaseNames[i].name},
                              {"lanes", phase.lanes},
                              {"longestLane", phase.longestLane},
                              {"loops", loops}});
        }
        out["points"].push_back({{"scene", point.scene},
                                 {"lights", point.lights},
                                 {"tiles", point.tiles},
                                 {"splitTiles", point.splitTiles},
                                 {"unlistedClusters", point.unlistedClusters},
                                 {"dispatches", phases}});
    }
    return out;
}

} // namespace candelabra::app
