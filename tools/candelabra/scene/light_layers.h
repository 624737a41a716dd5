// SPDX-License-Identifier: Apache-2.0
// Which lights a camera is for.
#pragma once

#include <vector>

#include "scene/scene.h"

namespace candelabra::app
{

// Whether the light has a layer in common with the camera.
bool isShown(const CndLight& light, const Camera& camera);

// Those that have a layer in common with the camera, in their order.
std::vector<CndLight> lightsShown(const std::vector<CndLight>& lights, const Camera& camera);

} // namespace candelabra::app
