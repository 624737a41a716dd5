// SPDX-License-Identifier: Apache-2.0
// Finds the meshes in which lights of a file are. Internal to the glTF loader.
#pragma once

#include <vector>

#include "scene/scene.h"

namespace candelabra::app
{

// The drawn body of a lamp must not shadow the lamp's light. A body is an instance that emits and
// surrounds a light: it hides the light in more than half of all directions, as a closed mesh does,
// and a bulb without its base. Bodies get the occluder layer lampBodyLayer, which does not shadow
// the lights in them. Shades that do not emit stay what they are. `positions`: of the scene's
// lights, in world space.
void findLampBodies(Scene& scene, const std::vector<glm::dvec3>& positions);

constexpr uint32_t lampBodyLayer = 1;

} // namespace candelabra::app
