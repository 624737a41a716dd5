// SPDX-License-Identifier: Apache-2.0
// Counts how often each digit occurs in each run of lights. A group counts those of a run.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernels/common/sort_run.glsl"

shared uint found[SORT_DIGITS];

void main()
{
    const uint run = indexOfGroup();
    if (run >= params.runCount)
        return;
    const uint lane = gl_LocalInvocationIndex;
    for (uint d = lane; d < SORT_DIGITS; d += SORT_GROUP)
        found[d] = 0u;
    barrier();
    const uint end = min(params.lightCount, (run + 1u) * SORT_RUN);
    for (uint i = run * SORT_RUN + lane; i < end; i += SORT_GROUP)
        atomicAdd(found[digitOf(from[i].key)], 1u);
    barrier();
    for (uint d = lane; d < SORT_DIGITS; d += SORT_GROUP)
        counts[d * params.runCount + run] = found[d];
}
