// SPDX-License-Identifier: Apache-2.0
// What a frame may ask of a view.
#pragma once

#include "view/module.h"

namespace candelabra::lighting
{

// Both throw gpu::Failure naming the first field outside its documented range. `view`: how the view
// was created.
void checkFrame(const Module& module, const CndLightingViewDesc& view,
                const CndLightingFrame& frame);
// Only what describes the surfaces, which an overlay reads as well.
void checkSurfaces(const Module& module, const CndLightingViewDesc& view,
                   const CndLightingFrame& frame);

} // namespace candelabra::lighting
