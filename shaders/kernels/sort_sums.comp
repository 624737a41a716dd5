// SPDX-License-Identifier: Apache-2.0
// Replaces the counters by their exclusive prefix sums. Each lane sums SORT_SUM counters by itself and
// writes their total.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernels/common/sort_run.glsl"

layout(scalar, binding = SORT_SUMS_COUNTS) buffer Counts
{
    uint counts[];
};
layout(scalar, binding = SORT_SUMS_SUMS) writeonly buffer Sums
{
    uint sums[];
};

void main()
{
    const uint lane = gl_GlobalInvocationID.x;
    const uint count = SORT_DIGITS * params.runCount;
    if (lane * SORT_SUM >= count)
        return;
    const uint end = min(count, (lane + 1u) * SORT_SUM);
    uint sum = 0u;
    for (uint i = lane * SORT_SUM; i < end; ++i) {
        const uint here = counts[i];
        counts[i] = sum;
        sum += here;
    }
    sums[lane] = sum;
}
