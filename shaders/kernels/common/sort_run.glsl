// SPDX-License-Identifier: Apache-2.0
// What the kernels of a sorting pass share: their parameters, the digit of a key, and who works on a
// run. On GPUs the lanes of a group work on one run together. On llvmpipe each lane has a run of its
// own.
#include "shared/light_order_data.h"
#include "shared/lighting_data.h"

layout(local_size_x = SORT_GROUP) in;
layout(constant_id = SPEC_LANES_TOGETHER) const bool lanesTogether = true;
layout(push_constant, scalar) uniform Push
{
    SortParams params;
};

// Returns the index of this group or lane, which works on the run, or the sum, of that index.
uint indexOfWorker()
{
    const uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    return lanesTogether ? group : group * SORT_GROUP + gl_LocalInvocationIndex;
}

uint digitOf(uint key)
{
    return key >> params.shift & (SORT_DIGITS - 1u);
}
