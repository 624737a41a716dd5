// SPDX-License-Identifier: Apache-2.0
// Counts how often each digit occurs in each run of lights.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernels/common/sort_run.glsl"

layout(scalar, binding = SORT_COUNT_KEYS) readonly buffer Keys
{
    LightKey keys[];
};
layout(scalar, binding = SORT_COUNT_COUNTS) writeonly buffer Counts
{
    uint counts[];
};

void countByLane(uint run)
{
    uint found[SORT_DIGITS];
    for (uint d = 0u; d < SORT_DIGITS; ++d)
        found[d] = 0u;
    const uint end = min(params.lightCount, (run + 1u) * SORT_RUN);
    for (uint i = run * SORT_RUN; i < end; ++i)
        ++found[digitOf(keys[i].key)];
    for (uint d = 0u; d < SORT_DIGITS; ++d)
        counts[d * params.runCount + run] = found[d];
}

shared uint foundByGroup[SORT_DIGITS];

void countByGroup(uint run)
{
    const uint lane = gl_LocalInvocationIndex;
    for (uint d = lane; d < SORT_DIGITS; d += SORT_GROUP)
        foundByGroup[d] = 0u;
    barrier();
    const uint end = min(params.lightCount, (run + 1u) * SORT_RUN);
    for (uint i = run * SORT_RUN + lane; i < end; i += SORT_GROUP)
        atomicAdd(foundByGroup[digitOf(keys[i].key)], 1u);
    barrier();
    for (uint d = lane; d < SORT_DIGITS; d += SORT_GROUP)
        counts[d * params.runCount + run] = foundByGroup[d];
}

void main()
{
    const uint run = indexOfWorker();
    if (run >= params.runCount)
        return;
    if (lanesTogether)
        countByGroup(run);
    else
        countByLane(run);
}
