// SPDX-License-Identifier: Apache-2.0
// Gives the surfaces of a scene to the lighting module as occluders.
#pragma once

#include "candelabra/candelabra.hpp"
#include "scene/scene.h"

namespace candelabra::app
{

// Adds everything of the scene that casts shadows (scene/shadow_casters.h). Meshes are the full
// ones, without levels of detail, and instances share them. Balls become a mesh inside of them,
// within 0.4% of their radius. Planes become a square that reaches far beyond the scene, because
// lights may be behind planes. `materials` has one material for each of the scene's, which it
// replaces. Throws RunError if the engine refuses something.
void addOccluders(Lighting& lighting, const Scene& scene, const std::vector<Material>& materials);

} // namespace candelabra::app
