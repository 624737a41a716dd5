// SPDX-License-Identifier: Apache-2.0
// Replaces the totals of sort_sums by their exclusive prefix sums, in one group.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernels/common/sort_run.glsl"
#include "kernels/common/group_sums.glsl"

void main()
{
    const uint lane = gl_LocalInvocationIndex;
    const uint count = (SORT_DIGITS * params.runCount + SORT_SUM - 1u) / SORT_SUM;
    const uint perLane = (count + SORT_GROUP - 1u) / SORT_GROUP;
    const uint first = min(count, lane * perLane);
    const uint end = min(count, first + perLane);
    uint total = 0u;
    for (uint i = first; i < end; ++i)
        total += sums[i];
    addPrefixes(total);
    uint before = prefixes[lane] - total;
    for (uint i = first; i < end; ++i) {
        const uint here = sums[i];
        sums[i] = before;
        before += here;
    }
}
