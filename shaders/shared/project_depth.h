// SPDX-License-Identifier: Apache-2.0
// The interface of project_depth, the kernel that computes the depth of the frame's projection from
// what the host stores in its place (CndDepthKind). All later kernels read its result, so they need
// to know one kind of depth only, and all of them read the same bits.
#ifndef CND_SHARED_PROJECT_DEPTH_H
#define CND_SHARED_PROJECT_DEPTH_H

#include "shared/frame.h"
#include "shared/host_gbuffer_data.h"

GPU_BEGIN

// One lane per pixel.
const uint PROJECT_DEPTH_GROUP = 8u; // x and y
const uint PROJECT_DEPTH_STORED = 0u;
const uint PROJECT_DEPTH_OUTPUT = 1u;
struct ProjectDepthParams {
    StoredDepth depth;
};
GPU_SIZE(ProjectDepthParams, 20)

GPU_END

#endif
