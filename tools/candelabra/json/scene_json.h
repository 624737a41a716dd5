// SPDX-License-Identifier: Apache-2.0
// Loads scene descriptions (.json). tools/SCENE_JSON.md describes their format.
#pragma once

#include <string>

#include "scene/scene.h"

namespace candelabra::app
{

// Throws SceneError with one sentence that names the file and the member.
Scene loadSceneJson(const std::string& path);

} // namespace candelabra::app
