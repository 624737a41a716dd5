// SPDX-License-Identifier: Apache-2.0
// Moves each light to the position that the sums over counted digits give it. Lights with equal digits
// keep their order. A group moves the lights of a run.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernels/common/sort_run.glsl"

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

void main()
{
    const uint run = indexOfGroup();
    if (run >= params.runCount)
        return;
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
