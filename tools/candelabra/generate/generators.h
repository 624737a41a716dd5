// SPDX-License-Identifier: Apache-2.0
// The scenes that the program generates, by their names on the command line.
#pragma once

#include <string>

#include "scene/scene.h"
#include "scene/scene_options.h"

namespace candelabra::app
{

// Returns true for "hall", "field", "fence" and "rooms", which are made for any number of lights.
bool isGenerated(const std::string& scene);
// Returns true for the generated scenes and for "showcase", whose lights are fixed.
bool isBuiltIn(const std::string& scene);

// The built-in scene of that name. Throws SceneError for options that make no sense.
Scene generateScene(const std::string& scene, const SceneOptions& options);

Scene generateHall(const SceneOptions& options);
Scene generateField(const SceneOptions& options);
Scene generateFence(const SceneOptions& options);
Scene generateRooms(const SceneOptions& options);
Scene generateShowcase(const SceneOptions& options); // one light of every type

} // namespace candelabra::app
