// SPDX-License-Identifier: Apache-2.0
#include "generate/lights.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include <fmt/format.h>

#include "candelabra/glm.hpp"
#include "io/table.h"
#include "scene/scene_error.h"

namespace candelabra::app
{
namespace
{

using std::numbers::pi_v;

// Rec.709 luminance weights (ITU-R BT.709-6).
glm::vec3 withUnitLuminance(const glm::vec3& rgb)
{
    return rgb / glm::dot(rgb, glm::vec3(0.2126f, 0.7152f, 0.0722f));
}

glm::dvec3 startOf(const LightSite& site)
{
    return site.position + glm::dvec3(site.motion.axisU * std::cos(site.motion.phase) +
                                      site.motion.axisV * std::sin(site.motion.phase));
}

OverlapScale findScale(const Scene& scene, const std::vector<LightReach>& reaches,
                       const SceneOptions& options)
{
    const std::vector<SurfaceSample> samples = visibleSamples(scene);
    if (samples.empty())
        throw SceneError(scene.name + ": lights: there is no surface for them to light");
    const double count = double(reaches.size());
    const double wanted = options.overlaps.value_or(std::min(defaultOverlaps, 0.5 * count));
    OverlapScale found = scaleForOverlaps(samples, reaches, wanted);
    if (found.scale == 0 && !options.overlaps)
        found = scaleForOverlaps(samples, reaches, 0.5 * found.reachable);
    if (found.scale == 0)
        throw SceneError(fmt::format("{}: overlaps: a mean of {:g} lights per pixel cannot be "
                                     "reached with {}, at most {:g} of them can light the average "
                                     "visible point",
                                     scene.name, wanted, counted(reaches.size(), "light"),
                                     found.reachable));
    return found;
}

CndLight makeLight(const LightSite& site, const LightReach& reach, double scale,
                   const glm::dvec3& origin)
{
    CndLight light{};
    light.type = CND_LIGHT_SPHERE;
    light.influenceRadius = float(scale * reach.reach);
    light.radius = float(std::min(reach.radius, reach.radiusShare * double(light.influenceRadius)));
    // I = E d^2, Phi = 4 pi I.
    const float luminousPower =
        4 * pi_v<float> * site.edgeIlluminance * light.influenceRadius * light.influenceRadius;
    const float luminance =
        site.luminance.value_or(cndSphereLuminanceFromPower(luminousPower, light.radius));
    assign(light.position, glm::vec3(site.position - origin));
    assign(light.emission, luminance * site.colour);
    return light;
}

} // namespace

glm::vec3 blackbodyColour(float kelvin)
{
    // Kim et al. 2002 (US patent 7024034), cubic fit of the Planckian locus in CIE xy.
    const float t = 1000 / kelvin;
    const float x = kelvin < 4000
                        ? ((-0.2661239f * t - 0.2343589f) * t + 0.8776956f) * t + 0.179910f
                        : ((-3.0258469f * t + 2.1070379f) * t + 0.2226347f) * t + 0.240390f;
    float y;
    if (kelvin < 2222) {
        y = ((-1.1063814f * x - 1.34811020f) * x + 2.18555832f) * x - 0.20219683f;
    } else if (kelvin < 4000) {
        y = ((-0.9549476f * x - 1.37418593f) * x + 2.09137015f) * x - 0.16748867f;
    } else {
        y = ((3.0817580f * x - 5.87338670f) * x + 3.75112997f) * x - 0.37001483f;
    }
    const glm::vec3 xyz{x / y, 1, (1 - x - y) / y};
    // IEC 61966-2-1: linear sRGB from CIE XYZ (D65). GLM takes columns.
    const glm::mat3 rgbFromXyz{3.2406f,  -0.9689f, 0.0557f, -1.5372f, 1.8758f,
                               -0.2040f, -0.4986f, 0.0415f, 1.0570f};
    return withUnitLuminance(glm::max(rgbFromXyz * xyz, glm::vec3(0)));
}

glm::vec3 hueColour(float hue, float saturation)
{
    // Smith 1978, hexcone: each channel is a clamped triangle wave of the hue.
    const glm::vec3 wave = glm::abs(glm::fract(hue + glm::vec3(0, 2, 1) / 3.0f) * 6.0f - 3.0f);
    const glm::vec3 pure = glm::clamp(wave - 1.0f, 0.0f, 1.0f);
    return withUnitLuminance(glm::mix(glm::vec3(1), pure, saturation));
}

float luminanceOfPeak(const glm::vec3& colour, float peak)
{
    return peak / std::max({colour.r, colour.g, colour.b});
}

LightMotion circleMotion(Random& random, double height, float lightRadius, float radius,
                         float speed)
{
    const float azimuth = 2 * pi_v<float> * random.uniform();
    const float tilt = random.uniform(-0.5f, 0.5f);
    const float turn = random.chance(0.5f) ? 1.0f : -1.0f;
    LightMotion motion;
    motion.phase = 2 * pi_v<float> * random.uniform();
    motion.angularSpeed = turn * speed / radius;
    const glm::vec2 d{std::cos(azimuth), std::sin(azimuth)};
    // Half of the room below is left, so that rounding cannot bring the light down.
    const float room = 0.5f * std::max(float(height) - lightRadius, 0.0f);
    motion.axisU = radius * glm::vec3(d.x, 0, d.y);
    motion.axisV = glm::vec3(-radius * d.y, glm::clamp(radius * tilt, -room, room), radius * d.x);
    return motion;
}

void checkLightOptions(const std::string& name, uint32_t count, const SceneOptions& options)
{
    if (count > maxLights)
        throw SceneError(
            fmt::format("{}: lights: {} is more than the limit of {}", name, count, maxLights));
    if (!options.overlaps)
        return;
    const double overlaps = *options.overlaps;
    if (!std::isfinite(overlaps) || overlaps <= 0)
        throw SceneError(
            fmt::format("{}: overlaps: must be a finite number above 0, not {:g}", name, overlaps));
    if (count > 0 && overlaps > count)
        throw SceneError(fmt::format("{}: overlaps: {:g} is more than the {}", name, overlaps,
                                     counted(count, "light")));
}

void addSphereLights(Scene& scene, const std::vector<LightSite>& sites, const SceneOptions& options)
{
    if (sites.empty())
        return;
    const double crowding =
        std::min(1.0, std::sqrt(double(defaultLightCount) / double(sites.size())));
    std::vector<LightReach> reaches;
    reaches.reserve(sites.size());
    for (const LightSite& site : sites) {
        const double radius = site.luminance ? double{site.radius} : crowding * site.radius;
        reaches.push_back({startOf(site), site.reach, radius, site.radiusShare});
    }
    const double scale = findScale(scene, reaches, options).scale;

    scene.lights.reserve(scene.lights.size() + sites.size());
    if (options.moving || !scene.lightMotions.empty()) {
        scene.lightMotions.resize(scene.lights.size());
        for (const LightSite& site : sites)
            scene.lightMotions.push_back(site.motion);
    }
    for (size_t i = 0; i < sites.size(); ++i)
        scene.lights.push_back(makeLight(sites[i], reaches[i], scale, scene.lightOrigin));
}

namespace
{

// Tells whether a light would fill more than a few percent of a camera's picture, wherever that
// camera turns.
bool standsInFront(const Scene& scene, const LightSite& site)
{
    constexpr double leastDistance = 60; // radii: an angle of 2 degrees
    return std::ranges::any_of(scene.cameras, [&](const Camera& camera) {
        const double distance = glm::length(site.position - camera.position);
        return !camera.orthographic && distance < leastDistance * double{site.radius};
    });
}

// Makes bounds that are thinner than `least` along some axis thicker by that much, along y only
// upwards.
void thickenBounds(Bounds& bounds, double least)
{
    for (int axis = 0; axis < 3; ++axis) {
        if (bounds.max[axis] - bounds.min[axis] >= least)
            continue;
        bounds.max[axis] += least;
        bounds.min[axis] -= axis == 1 ? 0 : least;
    }
}

} // namespace

void addRandomLights(Scene& scene, const SceneOptions& options, float edgeIlluminance)
{
    const uint32_t count = options.lights.value_or(0);
    checkLightOptions(scene.name, count, options);
    if (count == 0)
        return;
    Bounds bounds = sceneBounds(scene);
    const double diagonal = glm::length(bounds.max - bounds.min);
    // Below a micrometre, squares of the lights' sizes leave the range of floats.
    if (!std::isfinite(diagonal) || diagonal < 1e-6)
        throw SceneError(fmt::format("{}: lights: random lights need meshes that span at least a "
                                     "micrometre, these span {:g} m",
                                     scene.name, diagonal));
    thickenBounds(bounds, 0.1 * diagonal);
    const glm::dvec3 size = bounds.max - bounds.min;
    if (scene.lights.empty())
        scene.lightOrigin = 0.5 * (bounds.min + bounds.max);
    Random random(options.seed, 1), motionRandom(options.seed, 2);
    std::vector<LightSite> sites(count);
    for (LightSite& site : sites) {
        constexpr int tries = 8;
        for (int i = 0; i < tries; ++i) {
            site.position = bounds.min + glm::dvec3(random.uniform3()) * size;
            // Mostly small: 0.05% to 0.6% of the diagonal, the square favours the small ones.
            const float share = random.uniform();
            site.radius = float(diagonal) * (0.0005f + 0.0055f * share * share);
            if (!standsInFront(scene, site))
                break;
        }
        site.edgeIlluminance = edgeIlluminance;
        site.reach = random.uniform(0.7f, 1.5f);
        if (random.chance(0.4f)) {
            site.colour = blackbodyColour(random.uniform(2000, 7000));
        } else {
            const float hue = random.uniform();
            site.colour = hueColour(hue, random.uniform(0.4f, 0.85f));
        }
        if (options.moving) {
            const float radius = float(diagonal) * motionRandom.uniform(0.005f, 0.03f);
            site.motion = circleMotion(motionRandom, site.position.y - bounds.min.y, site.radius,
                                       radius, 0.7f * radius);
        }
    }
    addSphereLights(scene, sites, options);
}

} // namespace candelabra::app
