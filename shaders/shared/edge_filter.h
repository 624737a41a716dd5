// SPDX-License-Identifier: Apache-2.0
// Data that the program's edge filter and its kernel share.
#ifndef CND_SHARED_EDGE_FILTER_H
#define CND_SHARED_EDGE_FILTER_H

#include "shared/prelude.h"

GPU_BEGIN

// --- edge_filter: smooths the edges of a display image, one lane per column of EDGE_FILTER_ROWS
// pixels
const uint EDGE_FILTER_GROUP = 64u;
const uint EDGE_FILTER_ROWS = 8u;
const uint EDGE_FILTER_INPUT = 0u;
const uint EDGE_FILTER_OUTPUT = 1u;
struct EdgeFilterParams {
    uvec2 size;
};
GPU_SIZE(EdgeFilterParams, 8)

GPU_END

#endif
