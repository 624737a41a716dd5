// SPDX-License-Identifier: Apache-2.0
// Replaces the counters by their exclusive prefix sums over each SORT_SUM counters, and writes the
// totals of these. They are the work of a group, and each lane has a few successive counters.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernels/common/sort_run.glsl"
#include "kernels/common/group_sums.glsl"

uint totalOf(uint first, uint end)
{
    uint total = 0u;
    for (uint i = first; i < end; ++i)
        total += counts[i];
    return total;
}

void main()
{
    const uint count = SORT_DIGITS * params.runCount;
    const uint share = indexOfGroup();
    if (share * SORT_SUM >= count)
        return;
    const uint lane = gl_LocalInvocationIndex;
    const uint perLane = SORT_SUM / SORT_GROUP;
    const uint first = min(count, share * SORT_SUM + lane * perLane);
    const uint end = min(count, first + perLane);
    const uint total = totalOf(first, end);
    addPrefixes(total);
    addUp(first, end, prefixes[lane] - total);
    if (lane == SORT_GROUP - 1u)
        sums[share] = prefixes[lane];
}
