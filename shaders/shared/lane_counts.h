// SPDX-License-Identifier: Apache-2.0
// What the lanes of a kernel did, as counted by kernels that are compiled with COUNT_LANES
// (kernels/common/count_lanes.glsl) for `candelabra bench lanes`.
#ifndef CND_SHARED_LANE_COUNTS_H
#define CND_SHARED_LANE_COUNTS_H

#include "shared/prelude.h"

GPU_BEGIN

// The dispatches that are told apart.
const uint LANES_OF_TREE_LISTS = 0u;  // cluster_lists, clusters that find their lights in the tree
const uint LANES_OF_BLOCK_LISTS = 1u; // cluster_lists, blocks by the lists of larger blocks
const uint LANES_OF_TILE_LISTS = 2u;
const uint LANES_OF_SLICE_LISTS = 3u;
const uint LANES_OF_SHADING = 4u; // shade_tiles
const uint LANE_PHASES = 5u;

// The loops of a lane, which run one after the other in each of its rounds.
const uint LANE_LOOPS = 4u;

// One round of one lane: how often it ran each loop. Loops of cluster_lists: 0 tests a light, 1
// tests a node of the tree. Loops of shade_tiles: 0 tests a light, 1 evaluates one above the
// horizon, 2 near it, 3 across it.
struct LaneRound {
    uint phaseRound;       // phase << LANE_ROUND_BITS | round
    uint lane;             // counted through all work groups of the dispatch
    uint turns01, turns23; // 16 bits each, low half first
};
GPU_SIZE(LaneRound, 16)
const uint LANE_ROUND_BITS = 24u;

// The buffer of rounds begins with this. The rounds follow, in any order.
struct LaneRoundsHead {
    uint written; // rounds that there were, even if there was no room for them
    uint room;    // rounds that fit
    // Only runs of LANE_RUN groups whose number is `part` modulo `parts` are counted.
    uint part, parts;
};
GPU_SIZE(LaneRoundsHead, 16)
// How many consecutive work groups are always counted in the same part: a multiple of
// LISTS_TOGETHER (lists_together.glsl). The first group of each such set does more than the others,
// so parts would differ much if groups were dealt to them one by one. Besides, such groups may
// share a subgroup.
const uint LANE_RUN = 8u;
const uint LANE_COUNTS_BINDING = 0u; // of descriptor set 1

GPU_END

#endif
