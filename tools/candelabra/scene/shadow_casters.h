// SPDX-License-Identifier: Apache-2.0
// Which surfaces of a scene cast shadows. The renderer and the truth both ask here.
#pragma once

#include <string>
#include <vector>

#include "scene/scene.h"

namespace candelabra::app
{

// Tells whether a triangle of a mesh with this material casts a shadow. Blended ones, which
// includes transmissive ones, cast none. Masked ones cast a whole one if they are there on at least
// half of their area, and none otherwise: many files mask surfaces that have few holes or none, and
// walls among them must not let light through. `triangle` counts the triangles of the mesh.
bool castsShadow(const Scene& scene, const Material& material, const Mesh& mesh, size_t triangle);

// Returns one sentence for each kind of surface whose shadows are missing or not exact.
std::vector<std::string> inexactShadows(const Scene& scene);

} // namespace candelabra::app
