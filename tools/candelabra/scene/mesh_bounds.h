// SPDX-License-Identifier: Apache-2.0
// Axis-aligned boxes around meshes.
#pragma once

#include "scene/scene.h"

namespace candelabra::app
{

// In object space; {0,0} for a mesh without vertices.
Bounds meshBounds(const Mesh& mesh);

// The smallest box around the transformed box; never smaller than the box around its content.
Bounds transformBounds(const Bounds& bounds, const glm::dmat4& worldFromObject);

} // namespace candelabra::app
