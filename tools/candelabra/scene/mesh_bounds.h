// SPDX-License-Identifier: Apache-2.0
// Axis-aligned bounding boxes of meshes.
#pragma once

#include "scene/scene.h"

namespace candelabra::app
{

// The bounds in object space; {0,0} for a mesh without vertices.
Bounds meshBounds(const Mesh& mesh);

// The bounds in world space of a box that is in object space. They contain everything in the box.
Bounds transformBounds(const Bounds& bounds, const glm::dmat4& worldFromObject);

} // namespace candelabra::app
