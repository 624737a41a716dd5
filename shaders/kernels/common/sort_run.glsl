// SPDX-License-Identifier: Apache-2.0
// What the kernels of a sorting pass share: their parameters, and the digit of a key.
#include "shared/light_order.h"

layout(local_size_x = SORT_GROUP) in;
layout(push_constant, scalar) uniform Push
{
    SortParams params;
};

uint digitOf(uint key)
{
    return key >> params.shift & (SORT_DIGITS - 1u);
}
