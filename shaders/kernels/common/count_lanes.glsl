// SPDX-License-Identifier: Apache-2.0
// Counts how often the lanes of a kernel run its loops, for `candelabra bench lanes`. Without
// COUNT_LANES, which only that benchmark defines, the macros are empty. Include it after the size of
// the work group has been declared.
#ifndef CND_COMMON_COUNT_LANES
#define CND_COMMON_COUNT_LANES

#ifdef COUNT_LANES
#include "shared/lane_counts.h"

layout(scalar, set = 1, binding = LANE_COUNTS_BINDING) buffer LaneCounts
{
    LaneRoundsHead laneRoundsHead;
    LaneRound laneRounds[];
};

uint laneRound = 0u; // of this lane

void countRound(uint phase, uvec4 turns)
{
    const uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    if (group / LANE_RUN % laneRoundsHead.parts != laneRoundsHead.part)
        return;
    const uint at = atomicAdd(laneRoundsHead.written, 1u);
    const uint lanes = gl_WorkGroupSize.x * gl_WorkGroupSize.y;
    if (at < laneRoundsHead.room)
        laneRounds[at] = LaneRound(phase << LANE_ROUND_BITS | laneRound,
                                   group * lanes + gl_LocalInvocationIndex, turns.x | turns.y << 16u,
                                   turns.z | turns.w << 16u);
    ++laneRound;
}

uint bitsOf(uvec2 x)
{
    return uint(bitCount(x.x) + bitCount(x.y));
}

// light_walk.glsl: a block of `tests` lights, and those found.
#define COUNT_FOUND(tests, found)                                                                  \
    countRound(LANES_OF_SHADING, uvec4(tests, bitsOf((found).above), bitsOf((found).near),         \
                                       bitsOf((found).general)));
// cluster_lists: tests of lights and of nodes.
#define COUNT_LISTS(lights, nodes)                                                                 \
    countRound(params.which == LISTS_OF_BLOCKS                                                     \
                   ? (params.hasParents != 0u ? LANES_OF_BLOCK_LISTS : LANES_OF_TREE_LISTS)        \
               : params.which == LISTS_OF_TILES ? LANES_OF_TILE_LISTS                              \
                                                : LANES_OF_SLICE_LISTS,                            \
               uvec4(lights, nodes, 0u, 0u));
#else
#define COUNT_FOUND(tests, found)
#define COUNT_LISTS(lights, nodes)
#endif

#endif
