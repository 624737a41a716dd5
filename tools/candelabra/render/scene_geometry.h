// SPDX-License-Identifier: Apache-2.0
// A Scene in the terms of the default raster pass.
#pragma once

#include "gbuffer/geometry.h"
#include "scene/scene.h"

namespace candelabra::app
{

// On the GPU, ready to draw: uploads and waits. Throws gpu::Failure.
class VulkanContext;
gbuffer::Geometry uploadGeometry(const VulkanContext& context, const Scene& scene);

} // namespace candelabra::app
