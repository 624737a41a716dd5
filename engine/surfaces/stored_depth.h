// SPDX-License-Identifier: Apache-2.0
// The content of a frame's depth image (CndDepthKind), and the projection with which kernels turn
// it into positions.
#pragma once

#include "candelabra/candelabra.h"
#include "shared/frame.h"
#include "shared/host_gbuffer_data.h"

namespace candelabra::surfaces
{

// The projection of a frame, and the depth of pixels without a surface under it. For projected
// depths they are the host's. Other kinds come without a depth range: in perspective views their
// depth is 2^-10 m / w, reversed and infinite, which is as accurate near and far; in orthographic
// views it is that of clipFromView, where the far plane must have depth 1.
struct FrameDepth {
    gpu::Projection projection;
    float clear;
};
// Throws gpu::Failure if the projection is none that projectionOf takes.
FrameDepth frameDepth(CndDepthKind kind, const CndCamera& camera, float clearDepth);

// Returns how kernels read the image. `projection`: that of frameDepth().
gpu::StoredDepth storedDepth(const CndGBufferDesc& desc, const CndCamera& camera, float clearDepth,
                             const gpu::Projection& projection);

// Throws gpu::Failure if no pixel without a surface can be `clearDepth`. `frameName`: name of the
// frame's type.
void checkClearDepth(const char* frameName, CndDepthKind kind, const CndCamera& camera,
                     float clearDepth);

} // namespace candelabra::surfaces
