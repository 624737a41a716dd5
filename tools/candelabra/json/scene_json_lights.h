// SPDX-License-Identifier: Apache-2.0
// The lights of the small scene description. Internal to its loader.
//
// A light is an object with a "type" ("sphere" when left out), what places it, exactly one key for
// its emission, per Rec.709 channel [r, g, b], and, unless it is infinitely far away,
// "influence_radius" (default: unlimited). "direction" is the way the light travels.
//
//   type            placed by                                   emission
//   sphere          position, radius                            radiance, luminous_power, intensity
//   distant_sphere  direction, sin_angular_radius               radiance, illuminance
//   tube            start, end, radius                          radiance, luminous_power
//   rectangle       position, axis_u, axis_v [, two_sided]      radiance, luminous_power
//   disc            position, normal, radius [, two_sided]      radiance, luminous_power
//   point           position                                    intensity, luminous_power
//   spot            position, direction, inner_cone_degrees,    intensity, luminous_power
//                   outer_cone_degrees (half angles)
//   directional     direction                                   illuminance
//
// radiance may be called luminance: cd/m^2. luminous_power: lm. intensity: cd; a sphere's in the
// far field, a spot's on its axis. illuminance: lx, on a surface that faces the light. axis_u and
// axis_v go from the centre to the middle of an edge and of the next; the front is axis_u x axis_v.
// "layers" of any light: its layers by number, [0, 3] for instance (default: all).
#pragma once

#include "scene/json_value.h"
#include "scene/scene.h"

namespace candelabra::app
{

// [0, 3] as CndLight::layers. Throws SceneError.
uint32_t readLayers(const JsonValue& json);

// Appends the lights of the array `list` and places them (light_placement.h). Throws SceneError.
void readSceneLights(const JsonValue& list, Scene& scene);

} // namespace candelabra::app
