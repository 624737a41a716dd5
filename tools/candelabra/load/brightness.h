// SPDX-License-Identifier: Apache-2.0
// Measures how bright the light of a scene is. As in the engine, no surface casts a shadow.
#pragma once

#include "scene/scene.h"

namespace candelabra::app
{

// Returns the luminance of linear components of Rec. 709, in their unit.
double luminanceOf(const float (&rgb)[3]);

// Returns the direction of the middle of a pixel of an equirectangular image.
glm::dvec3 equirectangularDirection(const Image& image, uint32_t x, uint32_t y);

// Returns the illuminance in lx that an environment gives level ground, its scale included.
double groundIlluminance(const SceneEnvironment& environment);

// Returns the illuminance in lx that an environment gives a surface with a unit normal, which is
// relative to the image, before its rotation.
double planeIlluminance(const SceneEnvironment& environment, const glm::dvec3& normal);

// Returns the illuminance in lx that the directional lights and distant spheres of a scene give
// surfaces that face them, summed.
double sunIlluminance(const Scene& scene);

// Estimates the illuminance in lx of what the default camera sees: the mean over its surfaces of
// all lights and the environment. Area lights are taken for points, and surfaces get the light of
// an environment that level ground gets, so a factor of 2 is nothing unusual.
double typicalIlluminance(const Scene& scene);

} // namespace candelabra::app
