// SPDX-License-Identifier: Apache-2.0
// The lights of the small scene description. Internal to its loader.
//
// A light is an object with a "type" (default: "sphere"), the keys that place it, and exactly one
// key for its emission, an array [r, g, b] for the Rec.709 channels. Which keys a type has is in
// the table of scene/light_types.cpp. Unless a light is infinitely far away it may have an
// "influence_radius" (default: unlimited). "direction" is the direction in which the light travels.
// The cone angles of spots are half angles. axis_u and axis_v lead from the centre of a rectangle
// to the middles of two adjacent edges; its front faces along axis_u x axis_v. "corners" are the 3
// to 8 corners of a convex polygon, which go counterclockwise seen from its front. "two_sided" is
// false if it is missing.
//
// "radiance" may also be called "luminance"; it is in cd/m^2. "luminous_power" is in lm.
// "intensity" is in cd: for a sphere in the far field, for a spot on its axis. "illuminance" is in
// lx, on a surface that faces the light. Any light may have "layers", the numbers of its layers,
// such as [0, 3] (default: all).
//
// Any light may have "unshadowed": true means that nothing shadows it (default: false). Any light
// may have "unshadowed_by", the numbers of the occluder layers that do not shadow it, such as [1]
// (default: none). Objects have an "occluder_layer" (default: 0). In meshes of a glTF source, the
// bodies of the file's own lamps have layer 1 (gltf/lamp_bodies.h).
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

// Appends the lights of the array `list` to the scene's and places them (light_placement.h). Throws
// SceneError.
void readSceneLights(const JsonValue& list, Scene& scene);

} // namespace candelabra::app
