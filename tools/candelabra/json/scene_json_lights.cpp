// SPDX-License-Identifier: Apache-2.0
#include "json/scene_json_lights.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "scene/light_placement.h"
#include "scene/scene_file.h"

namespace candelabra::app
{

namespace
{

constexpr double pi = 3.14159265358979323846;
constexpr NumberRange coordinate{-maxCoordinate, maxCoordinate};
// Vectors that are not longer than this count as zero.
constexpr double minLength = 1e-6;

// A value of "type", and the keys of such lights: those that place it, which are required, those
// that are optional, and those of which exactly one gives the emission.
struct LightKind {
    const char* name;
    CndLightType type;
    std::vector<std::string> placement, optional, emission;
};

const LightKind kinds[] = {
    {"sphere",
     CND_LIGHT_SPHERE,
     {"position", "radius"},
     {"influence_radius"},
     {"radiance", "luminance", "luminous_power", "intensity"}},
    {"distant_sphere",
     CND_LIGHT_DISTANT_SPHERE,
     {"direction", "sin_angular_radius"},
     {},
     {"radiance", "luminance", "illuminance"}},
    {"tube",
     CND_LIGHT_TUBE,
     {"start", "end", "radius"},
     {"influence_radius"},
     {"radiance", "luminance", "luminous_power"}},
    {"rectangle",
     CND_LIGHT_RECTANGLE,
     {"position", "axis_u", "axis_v"},
     {"influence_radius", "two_sided"},
     {"radiance", "luminance", "luminous_power"}},
    {"disc",
     CND_LIGHT_DISC,
     {"position", "normal", "radius"},
     {"influence_radius", "two_sided"},
     {"radiance", "luminance", "luminous_power"}},
    {"point", CND_LIGHT_POINT, {"position"}, {"influence_radius"}, {"intensity", "luminous_power"}},
    {"spot",
     CND_LIGHT_SPOT,
     {"position", "direction", "inner_cone_degrees", "outer_cone_degrees"},
     {"influence_radius"},
     {"intensity", "luminous_power"}},
    {"directional", CND_LIGHT_DIRECTIONAL, {"direction"}, {}, {"illuminance"}}};

const LightKind& kindOf(const JsonValue& json)
{
    const auto type = json.find("type");
    if (!type)
        return kinds[0];
    std::string names;
    for (const LightKind& kind : kinds) {
        if (type->string() == kind.name)
            return kind;
        names += (names.empty() ? "" : ", ") + std::string(kind.name);
    }
    type->fail("must be one of " + names + ", is \"" + printable(type->string(), 60) + "\"");
}

void refuseOtherKeys(const JsonValue& json, const LightKind& kind)
{
    std::vector<std::string> known{"type", "layers"};
    for (const auto* keys : {&kind.placement, &kind.optional, &kind.emission})
        known.insert(known.end(), keys->begin(), keys->end());
    json.refuseOtherKeys(known);
}

void setVector(float (&out)[3], const glm::dvec3& v)
{
    for (int i = 0; i < 3; ++i)
        out[i] = static_cast<float>(v[i]);
}

void readUnit(const JsonValue& json, float (&out)[3])
{
    const glm::dvec3 v = json.vector3(coordinate);
    if (!(glm::length(v) > minLength))
        json.fail("must not be zero");
    setVector(out, glm::normalize(v));
}

float readRadius(const JsonValue& json, double max)
{
    const float radius = static_cast<float>(json.number(NumberRange::positive(max)));
    if (!(radius > 0))
        json.fail("is too small for single precision");
    return radius;
}

// Reads the ends of a tube. Returns its centre and sets axisU to half the vector from start to end.
glm::dvec3 readSegment(const JsonValue& json, CndLight& light)
{
    const glm::dvec3 start = json.member("start").vector3(coordinate);
    const glm::dvec3 end = json.member("end").vector3(coordinate);
    if (!(glm::length(end - start) > minLength))
        json.member("end").fail("must not be the same point as start");
    setVector(light.axisU, 0.5 * (end - start));
    return 0.5 * (start + end);
}

void readSides(const JsonValue& json, CndLight& light)
{
    const JsonValue jsonU = json.member("axis_u"), jsonV = json.member("axis_v");
    const glm::dvec3 u = jsonU.vector3(coordinate), v = jsonV.vector3(coordinate);
    if (!(glm::length(u) > minLength))
        jsonU.fail("must not be zero");
    if (!(glm::length(v) > minLength))
        jsonV.fail("must not be zero");
    // CndLight requires a cosine of at most 1e-3, in single precision.
    if (!(std::abs(glm::dot(glm::normalize(u), glm::normalize(v))) <= 0.99e-3))
        jsonV.fail("must be perpendicular to axis_u");
    setVector(light.axisU, u);
    setVector(light.axisV, v);
}

void readCone(const JsonValue& json, CndLight& light)
{
    const JsonValue inner = json.member("inner_cone_degrees");
    const JsonValue outer = json.member("outer_cone_degrees");
    const double innerAngle = inner.number({0, 90}) * pi / 180;
    const double outerAngle = outer.number(NumberRange::positive(90)) * pi / 180;
    light.innerConeAngle = static_cast<float>(innerAngle);
    light.outerConeAngle =
        std::min(static_cast<float>(outerAngle), std::nextafter(static_cast<float>(pi / 2), 0.0f));
    // The lighting module requires the same, because float cosines cannot resolve smaller
    // differences.
    const double apart = std::cos(static_cast<double>(light.innerConeAngle)) -
                         std::cos(static_cast<double>(light.outerConeAngle));
    if (!(apart >= 1e-6))
        outer.fail("must be greater than inner_cone_degrees: their cosines must differ by 1e-6");
}

// The distance from the centre of a light to the farthest point of its emitter.
double reachOf(const CndLight& light)
{
    const auto length = [](const float(&v)[3]) {
        return static_cast<double>(std::hypot(v[0], v[1], v[2]));
    };
    switch (light.type) {
    case CND_LIGHT_SPHERE:
    case CND_LIGHT_DISC:
        return static_cast<double>(light.radius);
    case CND_LIGHT_TUBE:
        return length(light.axisU) + static_cast<double>(light.radius);
    case CND_LIGHT_RECTANGLE:
        return std::hypot(length(light.axisU), length(light.axisV));
    default:
        return 0;
    }
}

void readInfluence(const JsonValue& json, CndLight& light)
{
    light.influenceRadius = INFINITY;
    const auto influence = json.find("influence_radius");
    if (!influence)
        return;
    light.influenceRadius = readRadius(*influence, maxCoordinate);
    if (static_cast<double>(light.influenceRadius) > reachOf(light) * (1 + 1e-6))
        return;
    const bool round = light.type == CND_LIGHT_SPHERE || light.type == CND_LIGHT_DISC;
    influence->fail(
        round ? "must be greater than radius"
              : "must be greater than the distance from the light's centre to its farthest point");
}

// The value of CndLight::emission, in the unit of the light's type (CndLightType), of a light that
// has one unit of the quantity that `key` names.
double emissionPerUnit(const std::string& key, CndLight light)
{
    if (key == "radiance" || key == "luminance")
        return 1;
    const double radius = static_cast<double>(light.radius);
    if (key == "intensity") // in the far field of a sphere I = pi R^2 L
        return light.type == CND_LIGHT_SPHERE ? 1 / (pi * radius * radius) : 1;
    if (key == "illuminance") // below a distant sphere E = pi s^2 L
        return light.type == CND_LIGHT_DISTANT_SPHERE ? 1 / (pi * radius * radius) : 1;
    // The power is proportional to the emission: it is computed for an emission of 1.
    for (float& emission : light.emission)
        emission = 1;
    float power[3] = {};
    cndLuminousPowerOfLight(&light, power, nullptr);
    return 1 / static_cast<double>(power[0]);
}

void readEmission(const JsonValue& json, const LightKind& kind, CndLight& light)
{
    const std::string* given = nullptr;
    for (const std::string& key : kind.emission) {
        if (!json.find(key))
            continue;
        if (given)
            json.member(key).fail("cannot be combined with \"" + *given + "\"");
        given = &key;
    }
    if (!given)
        json.fail("\"" + kind.emission.front() + "\" is missing");
    const JsonValue value = json.member(*given);
    const glm::dvec3 emission = value.vector3({0}) * emissionPerUnit(*given, light);
    setVector(light.emission, emission);
    for (const float e : light.emission)
        if (!std::isfinite(e))
            value.fail("needs an emission beyond single precision for so small a light");
}

CndLight readLight(const JsonValue& json, glm::dvec3& position)
{
    const LightKind& kind = kindOf(json);
    refuseOtherKeys(json, kind);
    CndLight light = {};
    light.type = kind.type;
    for (const std::string& key : kind.placement) {
        const JsonValue value = json.member(key);
        if (key == "position")
            position = value.vector3(coordinate);
        else if (key == "direction" || key == "normal")
            readUnit(value, light.direction);
        else if (key == "radius")
            light.radius = readRadius(value, maxCoordinate);
        else if (key == "sin_angular_radius")
            light.radius = readRadius(value, 1);
    }
    if (light.type == CND_LIGHT_TUBE)
        position = readSegment(json, light);
    if (light.type == CND_LIGHT_RECTANGLE)
        readSides(json, light);
    if (light.type == CND_LIGHT_SPOT)
        readCone(json, light);
    if (const auto twoSided = json.find("two_sided"))
        light.twoSided = twoSided->boolean() ? VK_TRUE : VK_FALSE;
    if (const auto layers = json.find("layers"))
        light.layers = readLayers(*layers);
    readInfluence(json, light);
    readEmission(json, kind, light);
    return light;
}

} // namespace

uint32_t readLayers(const JsonValue& json)
{
    json.requireArray();
    if (json.size() == 0)
        json.fail("must not be empty: leave it out for all layers");
    uint32_t layers = 0;
    for (size_t i = 0; i < json.size(); ++i)
        layers |= 1u << json.item(i).integer(0, CND_LAYER_COUNT - 1);
    return layers;
}

void readSceneLights(const JsonValue& list, Scene& scene)
{
    list.requireArray();
    std::vector<glm::dvec3> positions(list.size());
    for (size_t i = 0; i < list.size(); ++i)
        scene.lights.push_back(readLight(list.item(i), positions[i]));
    placeLights(scene, positions);
}

} // namespace candelabra::app
