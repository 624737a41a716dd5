// SPDX-License-Identifier: Apache-2.0
// Selects the lights that a camera sees by its layers.
#pragma once

#include <vector>

#include "scene/scene.h"

namespace candelabra::app
{

// True if the light has a layer in common with the camera. A mask of 0 stands for all layers.
bool isShown(const CndLight& light, const Camera& camera);

// The lights that have a layer in common with the camera, in the same order.
std::vector<CndLight> lightsShown(const std::vector<CndLight>& lights, const Camera& camera);

} // namespace candelabra::app
