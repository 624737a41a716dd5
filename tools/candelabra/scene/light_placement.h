// SPDX-License-Identifier: Apache-2.0
// Places lights. Their positions in files are in double precision, while CndLight has floats
// relative to Scene::lightOrigin.
#pragma once

#include <vector>

#include <glm/glm.hpp>

#include "scene/scene.h"

namespace candelabra::app
{

// Chooses scene.lightOrigin and sets the positions of scene.lights to `worldPositions`, which has
// one position per light in metres. The origin is 0 if no coordinate of a light exceeds 1024 m,
// where floats are 0.06 mm apart, else the centre of the positions' bounds. Lights that are
// infinitely far away have no position and are left alone.
void placeLights(Scene& scene, const std::vector<glm::dvec3>& worldPositions);

} // namespace candelabra::app
