// SPDX-License-Identifier: Apache-2.0
// Checks of what the host says in a frame.
#pragma once

#include "view/module.h"

namespace candelabra::lighting
{

// Both functions throw gpu::Failure naming the first field outside its documented range. `view` is
// what the view was created with.
// Returns the frame with the method that CND_SPECULAR_DEFAULT stands for.
CndLightingFrame checkedFrame(const Module& module, const CndLightingViewDesc& view,
                              const CndLightingFrame& asked);
// Checks only the fields that describe the surfaces, which are those that an overlay reads.
void checkSurfaces(const Module& module, const CndLightingViewDesc& view,
                   const CndLightingFrame& frame);

} // namespace candelabra::lighting
