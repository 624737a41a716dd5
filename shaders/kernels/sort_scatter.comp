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

// Returns the position of the first light of a run that has the digit.
uint firstOf(uint d, uint run)
{
    const uint at = d * params.runCount + run;
    return counts[at] + sums[at / SORT_SUM];
}

void scatterByLane(uint run)
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

// A bit for each light of the run, for each digit: whether the light has it.
const uint WORDS = SORT_RUN / 32u;
shared uint having[SORT_DIGITS * WORDS];

// Returns how many lights of the run before the i-th have the digit.
uint countBefore(uint d, uint i)
{
    uint count = bitCount(having[d * WORDS + i / 32u] & ((1u << i % 32u) - 1u));
    for (uint word = 0u; word < i / 32u; ++word)
        count += bitCount(having[d * WORDS + word]);
    return count;
}

void scatterByGroup(uint run)
{
    const uint lane = gl_LocalInvocationIndex;
    for (uint word = lane; word < SORT_DIGITS * WORDS; word += SORT_GROUP)
        having[word] = 0u;
    barrier();
    const uint first = run * SORT_RUN, count = min(params.lightCount - first, SORT_RUN);
    for (uint i = lane; i < count; i += SORT_GROUP)
        atomicOr(having[digitOf(from[first + i].key) * WORDS + i / 32u], 1u << i % 32u);
    barrier();
    for (uint i = lane; i < count; i += SORT_GROUP) {
        const LightKey light = from[first + i];
        const uint d = digitOf(light.key);
        to[firstOf(d, run) + countBefore(d, i)] = light;
    }
}

void main()
{
    const uint run = indexOfWorker();
    if (run >= params.runCount)
        return;
    if (lanesTogether)
        scatterByGroup(run);
    else
        scatterByLane(run);
}
