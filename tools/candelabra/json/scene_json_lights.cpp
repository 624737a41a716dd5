// SPDX-License-Identifier: Apache-2.0
#include "json/scene_json_lights.h"

#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "candelabra/glm.hpp"
#include "scene/cone.h"
#include "scene/light_types.h"
#include "scene/warnings.h"

namespace candelabra::app
{

namespace
{

using std::numbers::pi;
// Vectors that are not longer than this count as zero.
constexpr double minLength = 1e-6;

// The type that a light of a scene description has, a sphere if it does not say.
uint32_t typeOf(const JsonValue& json)
{
    const auto type = json.find("type");
    if (!type)
        return CND_LIGHT_SPHERE;
    std::string names;
    for (uint32_t i = 0; i < CND_LIGHT_TYPE_COUNT; ++i) {
        if (type->string() == lightTypeName(i))
            return i;
        names += (names.empty() ? "" : ", ") + std::string(lightTypeName(i));
    }
    type->fail("must be one of " + names + ", is \"" + printable(type->string(), 60) + "\"");
}

void refuseOtherKeys(const JsonValue& json, uint32_t type)
{
    std::vector<std::string> known{"type", "layers", "unshadowed", "unshadowed_by"};
    for (const LightKey& key : lightTypeInfo(type).keys)
        known.push_back(key.name);
    if (!cndIsDistant(type))
        known.push_back("influence_radius");
    const std::vector<std::string>& emission = lightTypeInfo(type).emission;
    known.insert(known.end(), emission.begin(), emission.end());
    json.refuseOtherKeys(known);
}

glm::dvec3 readAxis(const JsonValue& json)
{
    const glm::dvec3 v = json.vector3(coordinate);
    if (!(glm::length(v) > minLength))
        json.fail("must not be zero");
    return v;
}

void readUnit(const JsonValue& json, float (&out)[3])
{
    assign(out, glm::vec3(glm::normalize(readAxis(json))));
}

float readRadius(const JsonValue& json, double max)
{
    const float radius = float(json.number(NumberRange::positive(max)));
    if (!(radius > 0))
        json.fail("is too small for single precision");
    return radius;
}

// Reads the corners of a polygon. Floats hold them relative to the first one, so that those of a
// polygon far from the origin keep their shape.
void readCorners(const JsonValue& value, CndLight& light, glm::dvec3& position, CndPolygon& polygon)
{
    value.requireArray();
    if (value.size() < 3 || value.size() > CND_MAX_CORNERS)
        value.fail("must have 3 to " + std::to_string(CND_MAX_CORNERS) + " corners");
    const glm::dvec3 first = value.item(0).vector3(coordinate);
    float corners[CND_MAX_CORNERS][3] = {};
    for (size_t i = 1; i < value.size(); ++i)
        assign(corners[i], glm::vec3(value.item(i).vector3(coordinate) - first));
    CndError error{};
    if (cndPolygonFromCorners(corners, uint32_t(value.size()), &light, &polygon, &error) !=
        CND_SUCCESS)
        value.fail(error.message);
    position = first + glm::dvec3(toGlm(light.position));
}

// Reads what a key says of a light. `light` has what the keys before it said; `position` is that of
// the light, or the start of its segment.
void readKey(const JsonValue& value, LightKeyMeaning meaning, CndLight& light, glm::dvec3& position,
             Scene& scene, LoadWarnings& warnings)
{
    switch (meaning) {
    case LightKeyMeaning::Position:
    case LightKeyMeaning::SegmentStart:
        position = value.vector3(coordinate);
        return;
    case LightKeyMeaning::SegmentEnd: {
        const glm::dvec3 start = position, end = value.vector3(coordinate);
        if (!(glm::length(end - start) > minLength))
            value.fail("must not be the same point as start");
        assign(light.axisU, glm::vec3(0.5 * (end - start)));
        position = 0.5 * (start + end);
        return;
    }
    case LightKeyMeaning::Direction:
        readUnit(value, light.direction);
        return;
    case LightKeyMeaning::Radius:
        light.radius = readRadius(value, maxCoordinate);
        return;
    case LightKeyMeaning::Sine:
        light.radius = readRadius(value, 1);
        return;
    case LightKeyMeaning::AxisU:
        assign(light.axisU, glm::vec3(readAxis(value)));
        return;
    case LightKeyMeaning::AxisV: {
        const glm::dvec3 u(toGlm(light.axisU)), v = readAxis(value);
        // CndLight requires a cosine of at most 1e-3, in single precision.
        if (!(std::abs(glm::dot(glm::normalize(u), glm::normalize(v))) <= 0.99e-3))
            value.fail("must be perpendicular to axis_u");
        assign(light.axisV, glm::vec3(v));
        return;
    }
    case LightKeyMeaning::InnerCone:
        light.innerConeAngle = float(value.number({0, 90}) * pi / 180);
        return;
    case LightKeyMeaning::OuterCone: {
        const double outer = value.number(NumberRange::positive(90));
        const double inner = double{light.innerConeAngle} * 180 / pi;
        if (!setCone(double{light.innerConeAngle}, outer * pi / 180, light))
            warnings.add(value.path(),
                         fmt::format("must be greater than inner_cone_degrees, {:g}, by at least "
                                     "{:.2g}, is {:g}; the cone from {:.8g} to {:.8g} degrees is "
                                     "used",
                                     inner, double{CND_MIN_CONE_EDGE} * 180 / pi, outer,
                                     double{light.innerConeAngle} * 180 / pi,
                                     double{light.outerConeAngle} * 180 / pi));
        return;
    }
    case LightKeyMeaning::TwoSided:
        light.twoSided = value.boolean() ? VK_TRUE : VK_FALSE;
        return;
    case LightKeyMeaning::Corners: {
        const auto polygon = std::make_shared<CndPolygon>();
        readCorners(value, light, position, *polygon);
        scene.polygons.push_back(polygon);
        return;
    }
    }
}

void readInfluence(const JsonValue& json, CndLight& light)
{
    light.influenceRadius = INFINITY;
    const auto influence = json.find("influence_radius");
    if (!influence)
        return;
    light.influenceRadius = readRadius(*influence, maxCoordinate);
    if (light.influenceRadius > cndEmitterBoundingRadius(&light) * (1 + 1e-6f))
        return;
    influence->fail(
        cndLightFields(light.type) & CND_LIGHT_FIELD_AXIS_U_BIT
            ? "must be greater than the distance from the light's centre to its farthest point"
            : "must be greater than radius");
}

// The value of CndLight::emission, in the unit of the light's type (CndLightType), of a light that
// has one unit of the quantity that `key` names.
double emissionPerUnit(const std::string& key, CndLight light)
{
    if (key == "radiance" || key == "luminance")
        return 1;
    const double radius = double(light.radius);
    if (key == "intensity") // in the far field of a sphere I = pi R^2 L
        return cndIsPunctual(light.type) ? 1 : 1 / (pi * radius * radius);
    if (key == "illuminance") // below a distant sphere E = pi s^2 L
        return cndIsPunctual(light.type) ? 1 : 1 / (pi * radius * radius);
    // The power is proportional to the emission: it is computed for an emission of 1.
    for (float& emission : light.emission)
        emission = 1;
    float power[3] = {};
    cndLuminousPowerOfLight(&light, power, nullptr);
    return 1 / double(power[0]);
}

void readEmission(const JsonValue& json, CndLight& light)
{
    const std::vector<std::string>& keys = lightTypeInfo(light.type).emission;
    const std::string* given = nullptr;
    for (const std::string& key : keys) {
        if (!json.find(key))
            continue;
        if (given)
            json.member(key).fail("cannot be combined with \"" + *given + "\"");
        given = &key;
    }
    if (!given)
        json.fail("\"" + keys.front() + "\" is missing");
    const JsonValue value = json.member(*given);
    const glm::dvec3 emission = value.vector3({0}) * emissionPerUnit(*given, light);
    assign(light.emission, glm::vec3(emission));
    for (const float e : light.emission)
        if (!std::isfinite(e))
            value.fail("needs an emission beyond single precision for so small a light");
}

CndLight readLight(const JsonValue& json, glm::dvec3& position, Scene& scene,
                   LoadWarnings& warnings)
{
    CndLight light = {};
    light.type = typeOf(json);
    refuseOtherKeys(json, light.type);
    for (const LightKey& key : lightTypeInfo(light.type).keys) {
        const bool optional = key.meaning == LightKeyMeaning::TwoSided;
        if (!optional || json.find(key.name))
            readKey(json.member(key.name), key.meaning, light, position, scene, warnings);
    }
    if (const auto layers = json.find("layers"))
        light.layers = readLayers(*layers);
    if (const auto unshadowed = json.find("unshadowed"))
        light.unshadowed = unshadowed->boolean();
    if (const auto layers = json.find("unshadowed_by"))
        light.unshadowedBy = readLayers(*layers, CND_OCCLUDER_LAYER_COUNT, "no layer");
    readInfluence(json, light);
    readEmission(json, light);
    return light;
}

} // namespace

uint32_t readLayers(const JsonValue& json, uint32_t count, const char* otherwise)
{
    json.requireArray();
    if (json.size() == 0)
        json.fail(std::string("must not be empty: leave it out for ") + otherwise);
    uint32_t layers = 0;
    for (size_t i = 0; i < json.size(); ++i)
        layers |= 1u << json.item(i).integer(0, count - 1);
    return layers;
}

void readSceneLights(const JsonValue& list, Scene& scene)
{
    list.requireArray();
    std::vector<glm::dvec3> positions(list.size());
    LoadWarnings warnings;
    for (size_t i = 0; i < list.size(); ++i)
        scene.lights.push_back(readLight(list.item(i), positions[i], scene, warnings));
    placeLights(scene, positions);
    for (std::string& sentence : warnings.sentences(list.file()))
        scene.warnings.push_back(std::move(sentence));
}

} // namespace candelabra::app
