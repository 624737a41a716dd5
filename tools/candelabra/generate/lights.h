// SPDX-License-Identifier: Apache-2.0
// From "a light of this size and colour belongs here" to calibrated sphere lights.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <glm/glm.hpp>

#include "generate/light_overlaps.h"
#include "generate/random.h"
#include "scene/scene.h"
#include "scene/scene_options.h"

namespace candelabra::app
{

constexpr uint32_t defaultLightCount = 4000;
constexpr double defaultOverlaps = 8;

// A sphere light before its influence radius is known.
struct LightSite {
    glm::dvec3 position{0}; // world space
    // The radius in metres, and as a share of the influence radius; the smaller one is taken.
    float radius = 0.05f;
    float radiusShare = float(maxRadiusShare);
    float reach = 1;     // influence radius relative to that of the others, > 0
    glm::vec3 colour{1}; // linear Rec.709 with luminance 1
    // The luminance of the light in cd/m^2. Without one, the illuminance in lx at the distance of
    // the influence radius, on a surface that faces the light and before the window.
    std::optional<float> luminance;
    float edgeIlluminance = 2;
    LightMotion motion;
};

// Linear Rec.709 with luminance 1 (negative components cut). 1667..25000 K.
glm::vec3 blackbodyColour(float kelvin);
// Hue 0..1 around the colour circle (0 red, 1/3 green, 2/3 blue), saturation 0..1; luminance 1.
glm::vec3 hueColour(float hue, float saturation);

// Returns the luminance at which the brightest channel of an emitter of this colour has the value
// `peak` (cd/m^2). Tone curves fade bright colours to white by their brightest channel, so emitters
// of equal peak keep their colours equally well, whatever their hue.
float luminanceOfPeak(const glm::vec3& colour, float peak);

// A level to slightly tilted circle of `radius` metres around `position`, walked at about `speed`
// m/s, that stays above the floor `height` metres below it.
LightMotion circleMotion(Random& random, double height, float lightRadius, float radius,
                         float speed);

// Throws SceneError when options.lights or options.overlaps make no sense; `name` opens the
// sentence.
void checkLightOptions(const std::string& name, uint32_t count, const SceneOptions& options);

// Adds the sites as lights, their influence radii scaled so that a mean of options.overlaps lights
// (default 8, or half of what is possible when that is less) contributes to what the default camera
// sees; lights that the scene has already do not count. The more lights, the less far each of them
// reaches. The picture keeps its brightness for any number of lights in one of two ways:
// - Lights with a luminance keep it. Where the radius is a share of the influence radius, the
//   illuminance at the influence radius stays the same, too.
// - Other lights keep their illuminance at the influence radius, so their power grows with the
//   square of that radius. Their radii shrink with the square root of the count above the default
//   count, to keep the share of the picture that emitters cover.
// `scene.lightOrigin` must be final. Throws SceneError when explicit overlaps cannot be reached.
void addSphereLights(Scene& scene, const std::vector<LightSite>& sites,
                     const SceneOptions& options);

// Adds options.lights random sphere lights inside the scene's bounds; those of a flat scene are
// thickened, upwards or to both sides, because lights in its plane would not light it. Lights are
// so small and so far from every camera that none covers much of its picture. At the edge of its
// influence each gives `edgeIlluminance` lx.
void addRandomLights(Scene& scene, const SceneOptions& options,
                     float edgeIlluminance = LightSite{}.edgeIlluminance);

} // namespace candelabra::app
