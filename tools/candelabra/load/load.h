// SPDX-License-Identifier: Apache-2.0
// The one entry point that turns what a user typed as SCENE into a Scene.
#pragma once

#include <string>

#include "scene/scene.h"
#include "scene/scene_options.h"

namespace candelabra::app
{

// `scene` is "hall", "field", "fence", "rooms", "showcase", or the path of a .gltf, .glb or .json
// file. Throws SceneError.
Scene loadScene(const std::string& scene, const SceneOptions& options);

// Throws SceneError if the scene, which the user named `name`, has nothing that could be seen.
void requireSomethingToDraw(const Scene& scene, const std::string& name);

} // namespace candelabra::app
