// SPDX-License-Identifier: Apache-2.0
// Gives a scene to the device: its geometry to the raster pass, its surfaces as occluders to the
// lighting module, and its environment to the module of environments.
#pragma once

#include "candelabra/candelabra.hpp"
#include "gbuffer/geometry.h"
#include "render/vulkan_context.h"
#include "scene/scene.h"

namespace candelabra::app
{

// Uploads the geometry of the scene to the GPU, waits, and returns it ready to draw. `materials`:
// those of the scene, or as many others in their place. Throws gpu::Failure.
gbuffer::Geometry uploadGeometry(const VulkanContext& context, const Scene& scene,
                                 const std::vector<Material>& materials);

// Adds everything of the scene that casts shadows (scene/shadow_casters.h). Meshes are the full
// ones, without levels of detail, and instances share them. Balls become a mesh inside of them,
// within 0.4% of their radius. Planes become a square that reaches far beyond the scene, because
// lights may be behind planes. `materials` has one material for each of the scene's, which it
// replaces. Throws RunError if the engine refuses something.
void addOccluders(Lighting& lighting, const Scene& scene, const std::vector<Material>& materials);

// Returns the environment, ready for frames, with the size that suits its image. Throws UsageError,
// RunError or gpu::Failure.
Environment uploadEnvironment(const VulkanContext& context, const SceneEnvironment& environment,
                              CndEnvironmentDesc desc);

// Sets CndEnvironmentFrame::worldFromEnvironment to a rotation about the y axis by `rotation`
// radians, counter-clockwise seen from above.
void setEnvironmentRotation(double rotation, float (&worldFromEnvironment)[9]);

} // namespace candelabra::app
