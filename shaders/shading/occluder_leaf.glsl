// SPDX-License-Identifier: Apache-2.0
// The leaves of the trees of occluders: how many items they have left, and which is the first
// (OccluderNode::leaf).
#ifndef CND_SHADING_OCCLUDER_LEAF
#define CND_SHADING_OCCLUDER_LEAF

#include "shared/occluder_data.h"

uint leafCount(uint leaf)
{
    return leaf & OCCLUDER_LEAF_COUNT;
}

uint leafFirst(uint leaf)
{
    return leaf >> OCCLUDER_LEAF_SHIFT;
}

// Returns the leaf without its first item.
uint withoutFirst(uint leaf)
{
    return leaf + (1u << OCCLUDER_LEAF_SHIFT) - 1u;
}

#endif
