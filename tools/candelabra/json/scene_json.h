// SPDX-License-Identifier: Apache-2.0
// Loads scene descriptions (.json). Their format is described in scene_json.cpp.
#pragma once

#include <string>

#include "scene/scene.h"

namespace candelabra::app
{

// Throws SceneError with one sentence that names the file and the member.
Scene loadSceneJson(const std::string& path);

} // namespace candelabra::app
