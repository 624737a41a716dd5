// SPDX-License-Identifier: Apache-2.0
// What the kernels need of a CndCamera, and which cameras they can take.
#pragma once

#include "candelabra/candelabra.h"
#include "shared/frame.h"

namespace candelabra::surfaces
{

// Throws gpu::Failure when viewFromWorld is not a finite rotation and translation.
void checkCamera(const CndCamera& camera);

// The projection as the kernels read it: perspective or orthographic, any depth convention. Throws
// gpu::Failure for anything else. `clearDepth` (0 or 1) is the depth of the far end.
gpu::Projection projectionOf(const float (&clipFromView)[16], float clearDepth);

} // namespace candelabra::surfaces
