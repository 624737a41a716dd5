// SPDX-License-Identifier: Apache-2.0
// The forms of sort_count, sort_sums and sort_scatter for llvmpipe: each lane has a run, or SORT_SUM
// counters, to itself.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernels/common/sort_run.glsl"

layout(constant_id = SPEC_SORT_STEP) const uint sortStep = SORT_STEP_COUNT;

void countDigits(uint run)
{
    uint found[SORT_DIGITS];
    for (uint d = 0u; d < SORT_DIGITS; ++d)
        found[d] = 0u;
    const uint end = min(params.lightCount, (run + 1u) * SORT_RUN);
    for (uint i = run * SORT_RUN; i < end; ++i)
        ++found[digitOf(from[i].key)];
    for (uint d = 0u; d < SORT_DIGITS; ++d)
        counts[d * params.runCount + run] = found[d];
}

void scatter(uint run)
{
    uint next[SORT_DIGITS];
    for (uint d = 0u; d < SORT_DIGITS; ++d)
        next[d] = firstOf(d, run);
    const uint end = min(params.lightCount, (run + 1u) * SORT_RUN);
    for (uint i = run * SORT_RUN; i < end; ++i) {
        const LightKey light = from[i];
        const uint d = digitOf(light.key);
        to[next[d]] = light;
        ++next[d];
    }
}

void main()
{
    const uint lane = indexOfGroup() * SORT_GROUP + gl_LocalInvocationIndex;
    const uint first = lane * SORT_SUM, count = SORT_DIGITS * params.runCount;
    if (sortStep == SORT_STEP_SUMS) {
        if (first < count)
            sums[lane] = addUp(first, min(count, first + SORT_SUM), 0u);
    } else if (lane < params.runCount) {
        if (sortStep == SORT_STEP_COUNT)
            countDigits(lane);
        else
            scatter(lane);
    }
}
