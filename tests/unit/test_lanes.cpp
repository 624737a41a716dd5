// SPDX-License-Identifier: Apache-2.0
// Tests how rounds of lanes become turns, slots and chains (measure/lanes).
#include <vector>

#include <gtest/gtest.h>

#include "measure/lanes/lanes.h"

using namespace candelabra;
using app::LanePhase;

namespace
{

gpu::LaneRound roundOf(uint32_t phase, uint32_t at, uint32_t lane, uint32_t a, uint32_t b = 0,
                       uint32_t c = 0, uint32_t d = 0)
{
    return {phase << gpu::LANE_ROUND_BITS | at, lane, a | b << 16, c | d << 16};
}

app::LanePhases phasesOf(std::vector<gpu::LaneRound> rounds)
{
    app::LanePhases phases;
    app::addRounds(rounds, phases);
    return phases;
}

} // namespace

TEST(Lanes, EqualLanesWasteNothing)
{
    std::vector<gpu::LaneRound> rounds;
    for (uint32_t lane = 0; lane < 128; ++lane)
        rounds.push_back(roundOf(gpu::LANES_OF_SHADING, 0, lane, 5, 3));
    const LanePhase phase = phasesOf(rounds)[gpu::LANES_OF_SHADING];
    for (size_t width = 0; width < app::laneWidths.size(); ++width) {
        EXPECT_EQ(phase.loops[0].slots[width], 128u * 5);
        EXPECT_EQ(phase.loops[1].slots[width], 128u * 3);
        EXPECT_EQ(phase.efficiency(width), 1);
    }
    EXPECT_EQ(phase.lanes, 128u);
    EXPECT_EQ(phase.longestLane, 8u);
}

TEST(Lanes, OneBusyLaneKeepsItsSubgroupWaiting)
{
    const LanePhase phase =
        phasesOf({roundOf(gpu::LANES_OF_SHADING, 0, 70, 10)})[gpu::LANES_OF_SHADING];
    EXPECT_EQ(phase.loops[0].turns, 10u);
    EXPECT_EQ(phase.loops[0].slots[0], 8u * 10);
    EXPECT_EQ(phase.loops[0].slots[1], 32u * 10);
    EXPECT_EQ(phase.loops[0].slots[2], 64u * 10);
    EXPECT_EQ(phase.lanes, 1u);
}

// Lanes 0 and 8 are in different subgroups of 8 and in one of 32.
TEST(Lanes, RoundsAndLoopsWaitOneByOne)
{
    const LanePhase phase =
        phasesOf({roundOf(gpu::LANES_OF_TILE_LISTS, 1, 0, 1, 7),
                  roundOf(gpu::LANES_OF_TILE_LISTS, 0, 8, 4, 0),
                  roundOf(gpu::LANES_OF_TILE_LISTS, 0, 0, 9, 2),
                  roundOf(gpu::LANES_OF_TILE_LISTS, 1, 8, 6, 0)})[gpu::LANES_OF_TILE_LISTS];
    EXPECT_EQ(phase.loops[0].turns, 20u);
    EXPECT_EQ(phase.loops[0].slots[0], 8u * (9 + 1 + 4 + 6));
    EXPECT_EQ(phase.loops[0].slots[1], 32u * (9 + 6));
    EXPECT_EQ(phase.loops[1].slots[1], 32u * (2 + 7));
    EXPECT_EQ(phase.longestLane, 9u + 2 + 1 + 7);
    EXPECT_EQ(phase.longestWave[0], 9u + 6);
    EXPECT_EQ(phase.longestWave[1], 2u + 7);
}

TEST(Lanes, PhasesAndPartsAddUp)
{
    std::vector<gpu::LaneRound> first{roundOf(gpu::LANES_OF_SHADING, 0, 0, 3, 1, 2, 4)},
        second{roundOf(gpu::LANES_OF_SHADING, 0, 64, 30),
               roundOf(gpu::LANES_OF_TREE_LISTS, 0, 0, 2)};
    app::LanePhases phases;
    app::addRounds(first, phases);
    app::addRounds(second, phases);
    const LanePhase& shading = phases[gpu::LANES_OF_SHADING];
    EXPECT_EQ(shading.loops[0].turns, 33u);
    EXPECT_EQ(shading.loops[3].turns, 4u);
    EXPECT_EQ(shading.lanes, 2u);
    EXPECT_EQ(shading.longestLane, 30u);
    EXPECT_EQ(shading.longestWave[0], 30u);
    EXPECT_EQ(phases[gpu::LANES_OF_TREE_LISTS].loops[0].turns, 2u);
}
