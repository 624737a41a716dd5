// SPDX-License-Identifier: Apache-2.0
// The lights of the small scene description. Internal to its loader.
// tools/SCENE_JSON.md describes their keys. Which keys a type has is in the table of
// scene/light_types.cpp.
#pragma once

#include "scene/json_value.h"
#include "scene/scene.h"
#include "scene/scene_file.h"

namespace candelabra::app
{

// The valid coordinates and lengths.
inline constexpr NumberRange coordinate{-maxCoordinate, maxCoordinate};

// Reads the numbers of layers below `count`, such as [0, 3], as a mask. Without the key the mask
// would stand for `otherwise`. Throws SceneError.
uint32_t readLayers(const JsonValue& json, uint32_t count = CND_LAYER_COUNT,
                    const char* otherwise = "all layers");

// Appends the lights of the array `list` to the scene's and places them (scene.h). Throws
// SceneError.
void readSceneLights(const JsonValue& list, Scene& scene);

} // namespace candelabra::app
