// SPDX-License-Identifier: Apache-2.0
// Measures how well the lanes of subgroups of 8, 32 and 64 are used, and how long the longest chain
// of steps is that wait for each other, by counting on any device. What is counted does not depend
// on the size of the device's own subgroups.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "io/parse.h"
#include "io/progress.h"
#include "io/report.h"
#include "render/vulkan_context.h"
#include "shared/lane_counts.h"

namespace candelabra::app
{

constexpr std::array<uint32_t, 3> laneWidths{8, 32, 64};

// One loop of a kernel, over all lanes of its dispatches.
struct LaneLoop {
    uint64_t turns = 0; // by all lanes
    // By subgroup size: the lanes of a subgroup wait until the last of them has left the loop, so
    // each round takes as many slots as the lane with the most turns has, times the size.
    std::array<uint64_t, laneWidths.size()> slots{};
};

struct LanePhase {
    std::array<LaneLoop, gpu::LANE_LOOPS> loops;
    uint64_t lanes = 0;       // that had anything to do
    uint64_t longestLane = 0; // turns of the lane with the most turns, over all its loops
    // The same of the subgroup with the most turns, which waits for its slowest lane in every
    // round, by loop. For subgroups of 32.
    std::array<uint64_t, gpu::LANE_LOOPS> longestWave{};

    double efficiency(size_t width) const; // turns over slots, of all loops
};

using LanePhases = std::array<LanePhase, gpu::LANE_PHASES>;

// Adds the rounds of some whole work groups, and leaves the rounds in another order.
void addRounds(std::span<gpu::LaneRound> rounds, LanePhases& phases);

struct LaneSettings {
    std::vector<std::string> scenes{"hall", "field", "fence"};
    std::vector<uint32_t> lights{1000, 10'000, 100'000, 1'000'000};
    uint32_t overlaps = 8;
    PixelSize size{1920, 1080};
    uint32_t seed = 1;
};

struct LanePoint {
    std::string scene;
    uint32_t lights = 0;
    uint32_t tiles = 0, splitTiles = 0, unlistedClusters = 0;
    LanePhases phases;
};

// The engine must find Vulkan's functions through LaneCounter::functions in this context.
std::vector<LanePoint> measureLanes(const VulkanContext& context, const LaneSettings& settings,
                                    Progress& progress);
uint64_t laneSteps(const LaneSettings& settings);

std::string laneTable(const std::vector<LanePoint>& points);
Json laneJson(const LaneSettings& settings, const std::vector<LanePoint>& points);

} // namespace candelabra::app
