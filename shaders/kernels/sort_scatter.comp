// SPDX-License-Identifier: Apache-2.0
// Moves each light to the position that the sums over counted digits give it. Lights with equal digits
// keep their order.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernels/common/sort_run.glsl"

layout(scalar, binding = SORT_SCATTER_FROM) readonly buffer From
{
    LightKey from[];
};
layout(scalar, binding = SORT_SCATTER_TO) writeonly buffer To
{
    LightKey to[];
};
layout(scalar, binding = SORT_SCATTER_COUNTS) readonly buffer Counts
{
    uint counts[];
};
layout(scalar, binding = SORT_SCATTER_SUMS) readonly buffer Sums
{
    uint sums[];
};

void main()
{
    const uint run = gl_GlobalInvocationID.x;
    if (run >= params.runCount)
        return;
    uint next[SORT_DIGITS];
    for (uint d = 0u; d < SORT_DIGITS; ++d) {
        const uint at = d * params.runCount + run;
        next[d] = counts[at] + sums[at / SORT_SUM];
    }
    const uint end = min(params.lightCount, (run + 1u) * SORT_RUN);
    for (uint i = run * SORT_RUN; i < end; ++i) {
        const LightKey light = from[i];
        const uint d = digitOf(light.key);
        to[next[d]] = light;
        ++next[d];
    }
}
