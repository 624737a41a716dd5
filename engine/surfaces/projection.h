// SPDX-License-Identifier: Apache-2.0
// Checks a CndCamera and turns its projection into what kernels read.
#pragma once

#include "candelabra/candelabra.h"
#include "shared/frame.h"

namespace candelabra::surfaces
{

// Throws gpu::Failure if viewFromWorld is anything but a finite rotation and translation, such as a
// transposed one.
void checkCamera(const CndCamera& camera);

// Returns the projection as kernels read it. It may be perspective or orthographic, with any depth
// convention. Throws gpu::Failure for any other matrix. `clearDepth` (0 or 1) is the depth of the
// far end.
gpu::Projection projectionOf(const float (&clipFromView)[16], float clearDepth);

// Throws gpu::Failure if `clearDepth` (0 or 1) is the depth of the near end of a perspective
// projection. `frameName`: name of the frame's type.
void checkDepthDirection(const char* frameName, const gpu::Projection& projection,
                         float clearDepth);

} // namespace candelabra::surfaces
