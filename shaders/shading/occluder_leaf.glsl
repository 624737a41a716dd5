// SPDX-License-Identifier: Apache-2.0
// The items of a leaf of a tree over occluders (OccluderNode::leaf).
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
