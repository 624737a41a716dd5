// SPDX-License-Identifier: Apache-2.0
// Light positions in files are double; CndLight stores floats relative to Scene::lightOrigin.
#pragma once

#include <vector>

#include <glm/glm.hpp>

#include "scene/scene.h"

namespace candelabra::app
{

// Chooses scene.lightOrigin and writes scene.lights[i].position for world positions in metres, one
// per light. The origin stays at 0 while every light is within 1024 m of it (float step there:
// 0.06 mm), else it is the centre of the positions' bounds. Lights infinitely far away have no
// position.
void placeLights(Scene& scene, const std::vector<glm::dvec3>& worldPositions);

} // namespace candelabra::app
