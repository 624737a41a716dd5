// SPDX-License-Identifier: Apache-2.0
// A prefix sum that turns the light counts of the froxels into the starts of their lists. One group:
// each lane sums a run of counts, then replaces it.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/baselines.h"

layout(local_size_x = BASELINE_GROUP) in;
layout(push_constant, scalar) uniform Push
{
    BaselineScanParams params;
};
layout(scalar, binding = BASELINE_SCAN_HEADS) buffer Heads
{
    uint heads[];
};
layout(scalar, binding = BASELINE_SCAN_CURSORS) writeonly buffer Cursors
{
    uint cursors[];
};
layout(scalar, binding = BASELINE_SCAN_COUNTERS) buffer Counters
{
    BaselineCounters counters;
};
shared uint sums[BASELINE_GROUP];

void main()
{
    const uint lane = gl_LocalInvocationID.x;
    const uint run = (params.count + BASELINE_GROUP - 1u) / BASELINE_GROUP;
    const uint first = min(lane * run, params.count), end = min(first + run, params.count);
    uint sum = 0u;
    for (uint i = first; i < end; ++i)
        sum += heads[i];
    sums[lane] = sum;
    barrier();
    uint at = 0u;
    for (uint i = 0u; i < BASELINE_GROUP; ++i)
        at += i < lane ? sums[i] : 0u;
    for (uint i = first; i < end; ++i) {
        const uint count = heads[i];
        heads[i] = at;
        cursors[i] = at;
        at += count;
    }
    if (lane == BASELINE_GROUP - 1u) {
        heads[params.count] = at;
        counters.listEntries = at;
        counters.overflowed = at > params.entryCapacity ? 1u : 0u;
    }
}
