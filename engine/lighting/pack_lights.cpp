// SPDX-License-Identifier: Apache-2.0
#include "lighting/pack_lights.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "gpu/failure.h"

namespace candelabra::lighting
{
namespace
{

static_assert(gpu::LIGHT_POINT == CND_LIGHT_POINT);
static_assert(gpu::LIGHT_SPHERE == CND_LIGHT_SPHERE);
static_assert(gpu::LIGHT_SPOT == CND_LIGHT_SPOT);
static_assert(gpu::LIGHT_DIRECTIONAL == CND_LIGHT_DIRECTIONAL);

constexpr float infinity = std::numeric_limits<float>::infinity();

glm::vec3 vec(const float (&v)[3])
{
    return {v[0], v[1], v[2]};
}

// cos(inner) - cos(outer), which float cosines would lose for narrow cones.
double cosBetween(const CndLight& light)
{
    return std::cos(double(light.innerConeAngle)) - std::cos(double(light.outerConeAngle));
}

// Farther from their origin than this, squared distances are not finite floats.
constexpr float maxCoordinate = 1e15f;
// Between the cones of a spot light: what the device's float cosines can still resolve.
constexpr double minCosBetween = 1e-6;

bool isNear(const float (&v)[3])
{
    return std::abs(v[0]) <= maxCoordinate && std::abs(v[1]) <= maxCoordinate &&
           std::abs(v[2]) <= maxCoordinate; // false for NaN
}

// Why a light cannot be used, or null. Kept free of allocation: it runs a million times a frame.
const char* whyInvalid(const CndLight& light)
{
    if (light.type >= CND_LIGHT_TYPE_COUNT)
        return "type is not a CndLightType";
    for (const float e : light.emission)
        if (!(e >= 0 && e < infinity))
            return "emission must be finite and >= 0";
    const bool placed = light.type != CND_LIGHT_DIRECTIONAL;
    if (placed && !isNear(light.position))
        return "position must be finite and within 1e15 m of the origin";
    if (placed && !(light.influenceRadius > 0))
        return "influenceRadius must be > 0 (INFINITY for uncut)";
    if (light.type == CND_LIGHT_SPHERE) {
        if (!(light.radius > 0 && light.radius < infinity))
            return "radius must be finite and > 0";
        if (!(light.influenceRadius > light.radius))
            return "influenceRadius must be greater than radius";
    }
    if (light.type == CND_LIGHT_SPOT || light.type == CND_LIGHT_DIRECTIONAL) {
        const float length = std::hypot(light.direction[0], light.direction[1], light.direction[2]);
        if (!(std::abs(length - 1) <= 1e-3f))
            return "direction must be a unit vector";
    }
    if (light.type == CND_LIGHT_SPOT) {
        // float(pi / 2) may exceed the double by an ulp.
        constexpr float quarterTurn = float(std::numbers::pi / 2) * (1 + 1e-6f);
        if (!(light.innerConeAngle >= 0 && light.innerConeAngle < light.outerConeAngle &&
              light.outerConeAngle <= quarterTurn))
            return "cone angles must satisfy 0 <= inner < outer <= pi/2";
        if (cosBetween(light) < minCosBetween)
            return "cone angles are too close or too narrow (their cosines differ by less than "
                   "1e-6)";
    }
    return nullptr;
}

gpu::LightRecord pack(const CndLight& light)
{
    gpu::LightRecord r{};
    r.type = light.type;
    r.emission = vec(light.emission);
    r.influenceRadius = light.influenceRadius;
    if (light.type == CND_LIGHT_DIRECTIONAL) {
        // Reaches everywhere, and no part of it is ever below a horizon as far as culling knows.
        r.influenceRadius = infinity;
        r.radius = infinity;
    } else {
        r.position = vec(light.position);
    }
    if (light.type == CND_LIGHT_SPHERE)
        r.radius = light.radius;
    if (light.type == CND_LIGHT_SPOT || light.type == CND_LIGHT_DIRECTIONAL) {
        const glm::vec3 d = vec(light.direction);
        r.direction = d / std::hypot(d.x, d.y, d.z);
    }
    if (light.type == CND_LIGHT_SPOT) {
        // KHR_lights_punctual: attenuation is linear in the cosine between the cones, then squared.
        const double cosOuter = std::cos(double(light.outerConeAngle));
        r.spotScale = float(1 / cosBetween(light));
        r.spotOffset = float(-cosOuter / cosBetween(light));
    }
    return r;
}

} // namespace

bool validateLights(std::span<const CndLight> lights)
{
    bool onlySpheres = true;
    for (size_t i = 0; i < lights.size(); ++i) {
        if (const char* why = whyInvalid(lights[i]))
            gpu::failArgument("lights[" + std::to_string(i) + "]: " + why);
        onlySpheres = onlySpheres && lights[i].type == CND_LIGHT_SPHERE;
    }
    return onlySpheres;
}

void packLights(std::span<const CndLight> lights, std::span<gpu::LightRecord> out)
{
    for (size_t i = 0; i < lights.size(); ++i)
        out[i] = pack(lights[i]);
}

} // namespace candelabra::lighting
