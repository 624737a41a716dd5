// SPDX-License-Identifier: Apache-2.0
// Conversions between photometric units and between types of lights. Everything is computed in
// double precision and rounded once.
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "candelabra/candelabra.h"
#include "gpu/failure.h"
#include "lights/abi_vectors.h"
#include "lights/light_types.h"
#include "lights/polygon.h"

using namespace candelabra;

namespace
{

using lighting::dvec3From;
using lighting::setFloats;
using std::numbers::pi;
// Farther from the origin than this, squared distances are not finite floats.
constexpr double maxCoordinate = 1e15;

void requireType(const CndLight& light, CndLightType type, const char* what)
{
    if (light.type != uint32_t(type))
        gpu::failArgument(std::string(what) + ": the light to convert is of another type");
}

void requirePositive(double value, const char* what)
{
    if (!(value > 0 && value < std::numeric_limits<double>::infinity()))
        gpu::failArgument(std::string(what) + " must be finite and > 0, is " +
                          std::to_string(value));
}

// emission = factor * source.emission
void setEmission(CndLight& light, const CndLight& source, double factor)
{
    for (int i = 0; i < 3; ++i) {
        const double emission = factor * double(source.emission[i]);
        if (!(emission >= 0 && emission <= double(std::numeric_limits<float>::max())))
            gpu::failArgument("emission[" + std::to_string(i) +
                              "] of the converted light is not a finite float >= 0");
        light.emission[i] = float(emission);
    }
}

glm::dvec3 requireReceiver(const float* at)
{
    const glm::dvec3 receiver(at[0], at[1], at[2]);
    if (!(glm::length(receiver) <= maxCoordinate))
        gpu::failArgument("at must be finite and within 1e15 m of the origin");
    return receiver;
}

glm::dvec3 requireDirection(const CndLight& light)
{
    const glm::dvec3 direction = dvec3From(light.direction);
    if (!(std::abs(glm::length(direction) - 1) <= 1e-3))
        gpu::failArgument("direction of the light to convert must be a unit vector");
    return glm::normalize(direction);
}

double requireSine(float sine)
{
    if (!(sine >= 0 && sine <= 1))
        gpu::failArgument("sine must be between 0 and 1, is " + std::to_string(sine));
    return double(sine > 0 ? sine : CND_SUN_SINE);
}

// Returns the window of CndLight, (1 - (d / r)^4)^2, which is 0 from r on.
double window(double distance, double influenceRadius)
{
    const double q = distance / influenceRadius; // 0 for an infinite radius
    const double t = std::max(1 - q * q * q * q, 0.0);
    return t * t;
}

// The luminance of an area light of this shape that emits `luminousPower` lumens.
float luminanceFromPower(float luminousPower, const CndLight& light)
{
    return float(double(luminousPower) / lighting::luminousPowerPerEmission(light));
}

} // namespace

float cndSphereLuminanceFromPower(float luminousPower, float radius)
{
    return luminanceFromPower(luminousPower, {.type = CND_LIGHT_SPHERE, .radius = radius});
}

float cndSphereLuminanceFromIntensity(float intensity, float radius)
{
    return float(double(intensity) / (pi * double(radius) * double(radius)));
}

float cndTubeLuminanceFromPower(float luminousPower, float length, float radius)
{
    return luminanceFromPower(
        luminousPower, {.type = CND_LIGHT_TUBE, .radius = radius, .axisU = {length / 2, 0, 0}});
}

float cndRectangleLuminanceFromPower(float luminousPower, float width, float height,
                                     VkBool32 twoSided)
{
    return luminanceFromPower(luminousPower, {.type = CND_LIGHT_RECTANGLE,
                                              .axisU = {width / 2, 0, 0},
                                              .axisV = {0, height / 2, 0},
                                              .twoSided = twoSided});
}

float cndDiscLuminanceFromPower(float luminousPower, float radius, VkBool32 twoSided)
{
    return luminanceFromPower(luminousPower,
                              {.type = CND_LIGHT_DISC, .radius = radius, .twoSided = twoSided});
}

float cndPolygonLuminanceFromPower(float luminousPower, const CndLight* polygon)
{
    CndLight light = *polygon;
    light.type = CND_LIGHT_POLYGON;
    return luminanceFromPower(luminousPower, light);
}

float cndLuminousPowerFromWatts(float watts)
{
    return 683 * watts;
}

CndResult cndLuminousPowerOfLight(const CndLight* light, float luminousPower[3], CndError* error)
{
    return gpu::guard(error, [&] {
        gpu::requireNotNull("cndLuminousPowerOfLight", {light, luminousPower});
        if (light->type == CND_LIGHT_POLYGON)
            if (const char* why = lighting::whyPolygonInvalid(light->polygon))
                gpu::failArgument(why);
        CndLight power{}; // its emission is the power
        setEmission(power, *light, lighting::luminousPowerPerEmission(*light));
        for (int i = 0; i < 3; ++i)
            luminousPower[i] = power.emission[i];
    });
}

CndResult cndSphereFromPoint(const CndLight* point, float radius, const float at[3],
                             CndLight* sphere, CndError* error)
{
    return gpu::guard(error, [&] {
        gpu::requireNotNull("cndSphereFromPoint", {point, at, sphere});
        requireType(*point, CND_LIGHT_POINT, "cndSphereFromPoint");
        const double distance = glm::length(dvec3From(point->position) - requireReceiver(at));
        if (!(radius >= 0 && double(radius) < distance))
            gpu::failArgument("radius must be >= 0 and smaller than the distance from at to the "
                              "light, which is " +
                              std::to_string(distance) + " m");
        CndLight out{};
        out.layers = point->layers;
        out.type = CND_LIGHT_SPHERE;
        setFloats(out.position, dvec3From(point->position));
        out.influenceRadius = point->influenceRadius;
        // The radius chosen is smaller than influenceRadius even where the light does not reach
        // `at`.
        out.radius = radius > 0
                         ? radius
                         : float(std::min(1e-3 * distance, 0.25 * double(point->influenceRadius)));
        requirePositive(out.radius, "the radius chosen");
        if (!(out.radius < point->influenceRadius))
            gpu::failArgument("radius must be smaller than influenceRadius");
        setEmission(out, *point, 1 / (pi * double(out.radius) * double(out.radius)));
        *sphere = out;
    });
}

CndResult cndPointFromSphere(const CndLight* sphere, CndLight* point, CndError* error)
{
    return gpu::guard(error, [&] {
        gpu::requireNotNull("cndPointFromSphere", {sphere, point});
        requireType(*sphere, CND_LIGHT_SPHERE, "cndPointFromSphere");
        requirePositive(sphere->radius, "radius");
        CndLight out{};
        out.layers = sphere->layers;
        out.type = CND_LIGHT_POINT;
        setFloats(out.position, dvec3From(sphere->position));
        out.influenceRadius = sphere->influenceRadius;
        setEmission(out, *sphere, pi * double(sphere->radius) * double(sphere->radius));
        *point = out;
    });
}

CndResult cndDistantSphereFromDirectional(const CndLight* directional, float sine,
                                          CndLight* distantSphere, CndError* error)
{
    return gpu::guard(error, [&] {
        gpu::requireNotNull("cndDistantSphereFromDirectional", {directional, distantSphere});
        requireType(*directional, CND_LIGHT_DIRECTIONAL, "cndDistantSphereFromDirectional");
        CndLight out{};
        out.layers = directional->layers;
        out.type = CND_LIGHT_DISTANT_SPHERE;
        setFloats(out.direction, requireDirection(*directional));
        const double s = requireSine(sine);
        out.radius = float(s);
        setEmission(out, *directional, 1 / (pi * s * s));
        *distantSphere = out;
    });
}

CndResult cndDirectionalFromDistantSphere(const CndLight* distantSphere, CndLight* directional,
                                          CndError* error)
{
    return gpu::guard(error, [&] {
        gpu::requireNotNull("cndDirectionalFromDistantSphere", {distantSphere, directional});
        requireType(*distantSphere, CND_LIGHT_DISTANT_SPHERE, "cndDirectionalFromDistantSphere");
        requirePositive(distantSphere->radius, "radius");
        CndLight out{};
        out.layers = distantSphere->layers;
        out.type = CND_LIGHT_DIRECTIONAL;
        setFloats(out.direction, requireDirection(*distantSphere));
        setEmission(out, *distantSphere,
                    pi * double(distantSphere->radius) * double(distantSphere->radius));
        *directional = out;
    });
}

CndResult cndSphereFromDirectional(const CndLight* directional, const float at[3], float distance,
                                   float sine, CndLight* sphere, CndError* error)
{
    return gpu::guard(error, [&] {
        gpu::requireNotNull("cndSphereFromDirectional", {directional, at, sphere});
        requireType(*directional, CND_LIGHT_DIRECTIONAL, "cndSphereFromDirectional");
        const glm::dvec3 receiver = requireReceiver(at);
        const glm::dvec3 direction = requireDirection(*directional);
        if (!(distance >= 0))
            gpu::failArgument("distance must be >= 0, is " + std::to_string(distance));
        const double away = distance > 0 ? double(distance) : std::max(1e6, glm::length(receiver));
        const double s = requireSine(sine);
        CndLight out{};
        out.layers = directional->layers;
        out.type = CND_LIGHT_SPHERE;
        out.influenceRadius = std::numeric_limits<float>::infinity();
        setFloats(out.position, receiver - away * direction);
        if (!(glm::length(dvec3From(out.position)) <= maxCoordinate))
            gpu::failArgument("distance puts the light farther than 1e15 m from the origin");
        // The receiver sees the light where single precision has put it.
        const double actual = glm::length(dvec3From(out.position) - receiver);
        out.radius = float(s * away);
        if (!(out.radius > 0 && double(out.radius) < actual))
            gpu::failArgument("sine and distance put the receiver inside the light");
        const double actualSine = double(out.radius) / actual;
        setEmission(out, *directional, 1 / (pi * actualSine * actualSine));
        *sphere = out;
    });
}

CndResult cndDirectionalFromSphere(const CndLight* sphere, const float at[3], CndLight* directional,
                                   CndError* error)
{
    return gpu::guard(error, [&] {
        gpu::requireNotNull("cndDirectionalFromSphere", {sphere, at, directional});
        requireType(*sphere, CND_LIGHT_SPHERE, "cndDirectionalFromSphere");
        requirePositive(sphere->radius, "radius");
        const glm::dvec3 toReceiver = requireReceiver(at) - dvec3From(sphere->position);
        const double distance = glm::length(toReceiver);
        if (!(double(sphere->radius) < distance))
            gpu::failArgument("at must be outside the sphere light");
        CndLight out{};
        out.layers = sphere->layers;
        out.type = CND_LIGHT_DIRECTIONAL;
        setFloats(out.direction, toReceiver / distance);
        const double s = double(sphere->radius) / distance;
        setEmission(out, *sphere, pi * s * s * window(distance, double(sphere->influenceRadius)));
        *directional = out;
    });
}
