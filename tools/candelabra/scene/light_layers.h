// SPDX-License-Identifier: Apache-2.0
// Which lights a camera is for.
#pragma once

#include <vector>

#include "scene/scene.h"

namespace candelabra::app
{

// Those that have a layer in common with the camera, in their order.
std::vector<CndLight> lightsShown(const std::vector<CndLight>& lights, const Camera& camera);

} // namespace candelabra::app
