// SPDX-License-Identifier: Apache-2.0
// glTF 2.0 files (.gltf and .glb) as scenes.
#pragma once

#include <string>

#include "scene/scene.h"
#include "scene/scene_options.h"

namespace candelabra::app
{

// Returns true if `path` is a glTF file: by the extension of its name or, where that says nothing
// and the file exists, by its content. Throws SceneError if the content cannot be read, or is
// neither glTF nor a JSON object.
bool isGltf(const std::string& path);

// Throws SceneError.
Scene loadGltf(const std::string& path, const SceneOptions& options);

} // namespace candelabra::app
