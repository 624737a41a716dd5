// SPDX-License-Identifier: Apache-2.0
// What the kernels of a sorting pass share: their groups, parameters and bindings, and the digit of a
// key.
#include "shared/light_order_data.h"

layout(local_size_x = SORT_GROUP) in;
layout(push_constant, scalar) uniform Push
{
    SortParams params;
};
layout(scalar, binding = SORT_FROM) readonly buffer From
{
    LightKey from[];
};
layout(scalar, binding = SORT_TO) writeonly buffer To
{
    LightKey to[];
};
layout(scalar, binding = SORT_COUNTS) buffer Counts
{
    uint counts[];
};
layout(scalar, binding = SORT_SUMS) buffer Sums
{
    uint sums[];
};

uint indexOfGroup()
{
    return gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
}

uint digitOf(uint key)
{
    return key >> params.shift & (SORT_DIGITS - 1u);
}

// Replaces the counters first .. end - 1 by `before` plus their exclusive prefix sums. Returns `before`
// plus the total.
uint addUp(uint first, uint end, uint before)
{
    for (uint i = first; i < end; ++i) {
        const uint here = counts[i];
        counts[i] = before;
        before += here;
    }
    return before;
}

// Returns the position of the first light of a run that has the digit.
uint firstOf(uint d, uint run)
{
    const uint at = d * params.runCount + run;
    return counts[at] + sums[at / SORT_SUM];
}
