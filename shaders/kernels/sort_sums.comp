// SPDX-License-Identifier: Apache-2.0
// Replaces the counters by their exclusive prefix sums over each SORT_SUM counters, and writes the
// totals of these. They are the work of a group, or of a lane.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernels/common/sort_run.glsl"
#define GROUP_LANES SORT_GROUP
#include "kernels/common/group_sums.glsl"

layout(scalar, binding = SORT_SUMS_COUNTS) buffer Counts
{
    uint counts[];
};
layout(scalar, binding = SORT_SUMS_SUMS) writeonly buffer Sums
{
    uint sums[];
};

// Replaces the counters first .. end - 1 by `before` plus their exclusive prefix sums. Returns `before`
// plus the total.
uint addUp(uint first, uint end, uint before)
{
    for (uint i = first; i < end; ++i) {
        const uint here = counts[i];
        counts[i] = before;
        before += here;
    }
    return before;
}

uint totalOf(uint first, uint end)
{
    uint total = 0u;
    for (uint i = first; i < end; ++i)
        total += counts[i];
    return total;
}

// Each lane has a few successive counters.
void addUpByGroup(uint share, uint count)
{
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

void main()
{
    const uint count = SORT_DIGITS * params.runCount;
    const uint share = indexOfWorker();
    const uint first = share * SORT_SUM;
    if (first >= count)
        return;
    if (lanesTogether)
        addUpByGroup(share, count);
    else
        sums[share] = addUp(first, min(count, first + SORT_SUM), 0u);
}
