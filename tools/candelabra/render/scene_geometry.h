// SPDX-License-Identifier: Apache-2.0
// Converts the geometry of a Scene for the default raster pass.
#pragma once

#include "gbuffer/geometry.h"
#include "scene/scene.h"

namespace candelabra::app
{

class VulkanContext;

// Uploads the geometry of the scene to the GPU, waits, and returns it ready to draw. `materials`:
// those of the scene, or as many others in their place. Throws gpu::Failure.
gbuffer::Geometry uploadGeometry(const VulkanContext& context, const Scene& scene,
                                 const std::vector<Material>& materials);

} // namespace candelabra::app
