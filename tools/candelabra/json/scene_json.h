// SPDX-License-Identifier: Apache-2.0
// Scene descriptions (.json) as scenes; scene_json.cpp says what they hold.
#pragma once

#include <string>

#include "scene/scene.h"

namespace candelabra::app
{

// Throws SceneError.
Scene loadSceneJson(const std::string& path);

} // namespace candelabra::app
