// SPDX-License-Identifier: Apache-2.0
// From "a light of this size and colour belongs here" to calibrated sphere lights.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "generate/random.h"
#include "scene/scene.h"
#include "scene/scene_options.h"

namespace candelabra::app
{

constexpr uint32_t defaultLightCount = 4000;
constexpr double defaultOverlaps = 8;

// A sphere light before its influence radius is known.
struct LightSite {
    glm::dvec3 position{0};    // world space
    float radius = 0.05f;      // metres; shrinks in crowds, see addSphereLights
    float reach = 1;           // influence radius relative to that of the others, > 0
    glm::vec3 colour{1};       // linear Rec.709 with luminance 1
    float edgeIlluminance = 2; // lx, from the light at the distance of its influence radius,
                               // facing it and before the window
    LightMotion motion;
};

// Linear Rec.709 with luminance 1 (negative components cut). 1667..25000 K.
glm::vec3 blackbodyColour(float kelvin);
// Hue 0..1 around the colour circle (0 red, 1/3 green, 2/3 blue), saturation 0..1; luminance 1.
glm::vec3 hueColour(float hue, float saturation);

// A level to slightly tilted circle of `radius` metres around `position`, walked at about `speed`
// m/s, that stays above the floor `height` metres below it.
LightMotion circleMotion(Random& random, double height, float lightRadius, float radius,
                         float speed);

// Throws SceneError when options.lights or options.overlaps make no sense; `name` opens the
// sentence.
void checkLightOptions(const std::string& name, uint32_t count, const SceneOptions& options);

// Adds the sites as lights, their influence radii scaled so that a mean of options.overlaps lights
// (default 8, or half of what is possible when that is less) contributes to what the default camera
// sees; lights that the scene has already do not count. A light's illuminance at its influence
// radius is fixed, so its power grows with the square of the radius and the picture keeps its
// brightness for any number of lights. Radii shrink with the square root of the count above the
// default count, to keep the share of the picture that emitters cover. `scene.lightOrigin` must be
// final. Throws SceneError when explicit overlaps cannot be reached.
void addSphereLights(Scene& scene, const std::vector<LightSite>& sites,
                     const SceneOptions& options);

// Adds options.lights random sphere lights inside the scene's bounds.
void addRandomLights(Scene& scene, const SceneOptions& options);

} // namespace candelabra::app
