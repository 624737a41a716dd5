// SPDX-License-Identifier: Apache-2.0
// The lanes of a group of cluster_lists, at most 32, and what they decide together. Subgroups may have
// any size. All lanes call each function, in the same order.
#ifndef CND_COMMON_LANE_GROUP
#define CND_COMMON_LANE_GROUP

#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_ballot : require

#include "shared/cluster_data.h"

layout(local_size_x = CLUSTER_LISTS_GROUP, local_size_x_id = SPEC_LISTS_LANES) in;
layout(constant_id = SPEC_LISTS_LANES) const uint LANES = CLUSTER_LISTS_GROUP;

uint lane;            // index of this lane in the group
bool oneSubgroup;     // one subgroup holds the group
bool ballotsAreLanes; // and it has no other lanes, so its ballots have a bit per lane

// Only groups of several subgroups use these. Three answers take turns: the present one, the previous
// one, which slow subgroups may still be reading, and the next one, which is 0.
shared uint answers[3];
shared uint wordOfLane0;
uint turn; // index of the next answer

void beginLanes()
{
    oneSubgroup = gl_NumSubgroups == 1u;
    ballotsAreLanes = oneSubgroup && gl_SubgroupSize == LANES;
    lane = ballotsAreLanes ? gl_SubgroupInvocationID : gl_LocalInvocationIndex;
    turn = 0u;
    if (!oneSubgroup) {
        if (lane < 3u)
            answers[lane] = 0u;
        barrier();
    }
}

// Waits for all lanes, and makes visible to them what the lanes have written to shared memory.
void syncLanes()
{
    if (oneSubgroup) {
        subgroupMemoryBarrierShared();
        subgroupBarrier();
    } else {
        barrier();
    }
}

// Returns a word whose bit k tells whether lane k says yes.
uint lanesThatSay(bool yes)
{
    if (ballotsAreLanes)
        return subgroupBallot(yes).x;
    const uint inSubgroup = subgroupOr(yes ? 1u << lane : 0u);
    if (oneSubgroup)
        return inSubgroup;
    if (subgroupElect())
        atomicOr(answers[turn], inSubgroup);
    barrier();
    const uint answer = answers[turn];
    turn = turn == 2u ? 0u : turn + 1u;
    if (lane == 0u)
        answers[turn == 2u ? 0u : turn + 1u] = 0u;
    return answer;
}

// Returns how many lanes before this one are in a word of lanesThatSay.
uint lanesBefore(uint lanes)
{
    return uint(bitCount(lanes & ((1u << lane) - 1u)));
}

// Returns the value that lane 0 gives. Between two calls the lanes call lanesThatSay.
uint fromLane0(uint value)
{
    if (ballotsAreLanes)
        return subgroupBroadcastFirst(value);
    if (oneSubgroup)
        return subgroupOr(lane == 0u ? value : 0u);
    if (lane == 0u)
        wordOfLane0 = value;
    barrier();
    return wordOfLane0;
}

#endif
