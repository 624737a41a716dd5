// SPDX-License-Identifier: Apache-2.0
// Loads glTF 2.0 files (.gltf and .glb) as scenes.
#pragma once

#include <string>

#include "scene/scene.h"
#include "scene/scene_options.h"

namespace candelabra::app
{

// Returns true if `path` is a glTF file. The extension of its name decides; if it is neither .gltf,
// .glb nor .json and the file exists, its content decides. Throws SceneError if the content cannot
// be read, or is neither glTF nor a JSON object.
bool isGltf(const std::string& path);

// Throws SceneError with one sentence that names the file and the element.
Scene loadGltf(const std::string& path, const SceneOptions& options);

} // namespace candelabra::app
