// SPDX-License-Identifier: Apache-2.0
#include "gltf/lights.h"

#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>

#include "candelabra/glm.hpp"
#include "scene/cone.h"
#include "scene/json_value.h"
#include "scene/scene_error.h"
#include "scene/scene_file.h"

namespace candelabra::app
{

namespace
{

using std::numbers::pi;

constexpr float smallestRadius = 1e-15f; // metres, of CndLight

struct Emission {
    glm::dvec3 color{1};
    double intensity = 1;
};

// Sets the light's emission. glTF allows colours above 1, so only their product with the intensity
// is checked: it must fit into single precision.
void setEmission(const GltfDocument& document, const std::string& element, const Emission& e,
                 CndLight& light)
{
    for (int i = 0; i < 3; ++i) {
        const double value = e.color[i] * e.intensity;
        if (!(value <= double(std::numeric_limits<float>::max())))
            document.fail(element, "emits more than single precision holds");
        light.emission[i] = float(value);
    }
}

void setInfluence(const GltfDocument& document, const std::string& element, double range,
                  CndLight& light)
{
    light.influenceRadius = INFINITY;
    if (range == 0) // it has none
        return;
    // Among the lights of glTF only rectangles have axes.
    const bool hasAxes = cndLightFields(light.type) & CND_LIGHT_FIELD_AXIS_U_BIT;
    const float size = cndEmitterBoundingRadius(&light);
    if (float(range) > size * (hasAxes ? 1 + 1e-6f : 1.0f))
        light.influenceRadius = float(range);
    else
        document.warn(element + ".range",
                      fmt::format("must be greater than {}, {:g}, is {:g}; the light has no range",
                                  hasAxes ? "half the light's diagonal" : "the light's radius",
                                  size, range));
}

void setRadius(const GltfDocument& document, const std::string& element, double radius,
               CndLight& light)
{
    light.radius = float(radius);
    if (!(light.radius >= smallestRadius) || !(radius <= maxCoordinate))
        document.fail(element,
                      fmt::format("has a radius of {:g} m, which must be 1e-15 to 1e12", radius));
}

// A radius that a file gives to a light, and where it stands.
struct GivenRadius {
    double metres = 0;
    std::string element;
};

// Reads extras.radius of a light or of a node. "extras" may hold anything: it is used only if it is
// an object with a "radius".
std::optional<GivenRadius> extrasRadius(const GltfDocument& document, const nlohmann::json& owner,
                                        const std::string& element)
{
    const auto extras = owner.find("extras");
    if (extras == owner.end() || !extras->is_object() || !extras->contains("radius"))
        return std::nullopt;
    const JsonValue value(document.file, *extras, element + ".extras");
    try {
        const NumberRange range{double{smallestRadius}, maxCoordinate};
        return GivenRadius{value.member("radius").number(range), element};
    } catch (const SceneError& error) {
        document.warnInstead(error, "the light has no such radius");
        return std::nullopt;
    }
}

// Returns the radius that the file gives to the light of a node. The node's own comes first,
// because several nodes may share a light. Blender up to version 3.5 puts a light into a node of
// its own, called ..._Orientation, below the node of the object, whose extras are meant for the
// light.
std::optional<GivenRadius> givenRadius(const GltfDocument& document, const GltfPlacedNode& placed,
                                       const nlohmann::json& light, const std::string& element)
{
    const nlohmann::json& nodes = document.json["nodes"];
    auto radius = extrasRadius(document, nodes[placed.node], gltfElement("nodes", placed.node));
    if (!radius && placed.parent && nodes[placed.node].value("name", "").ends_with("_Orientation"))
        radius =
            extrasRadius(document, nodes[*placed.parent], gltfElement("nodes", *placed.parent));
    return radius ? radius : extrasRadius(document, light, element);
}

// Sets the light's direction to the node's -z axis. Returns false if that axis has length 0.
bool setDirection(const glm::dmat4& worldFromNode, CndLight& light)
{
    const glm::dvec3 z(worldFromNode[2]);
    const double length = glm::length(z);
    if (!(length > 0))
        return false;
    for (int i = 0; i < 3; ++i)
        light.direction[i] = float(0 - z[i] / length); // avoids negative zeros
    return true;
}

void readCone(const GltfDocument& document, const std::string& element,
              const tinygltf::SpotLight& spot, CndLight& light)
{
    if (!setCone(spot.innerConeAngle, spot.outerConeAngle, light))
        document.warn(
            element + ".spot",
            fmt::format("innerConeAngle must be at least {:g} below outerConeAngle, and that at "
                        "most pi/2; they are {:g} and {:g}; {:g} and {:g} are used",
                        CND_MIN_CONE_EDGE, spot.innerConeAngle, spot.outerConeAngle,
                        light.innerConeAngle, light.outerConeAngle));
}

// Turns a point light into a sphere, and a spot into a disc, of the same intensity: along its axis
// in the case of the disc, which has the cosine of the angle to the axis in place of the spot's
// cone.
void giveRadius(const GltfDocument& document, const std::string& element, double radius,
                CndLight& light, Emission& emission)
{
    light.type = light.type == CND_LIGHT_SPOT ? CND_LIGHT_DISC : CND_LIGHT_SPHERE;
    setRadius(document, element, radius, light);
    emission.intensity /= pi * radius * radius; // I = pi R^2 L
}

void addPunctual(const GltfDocument& document, size_t index, const GltfPlacedNode& placed,
                 const SceneOptions& options, GltfLights& out)
{
    const std::string element = "extensions.KHR_lights_punctual." + gltfElement("lights", index);
    const tinygltf::Light& source = document.model.lights[index];
    const nlohmann::json& json =
        (*GltfDocument::extension(document.json, "KHR_lights_punctual"))["lights"][index];
    CndLight light = {};
    Emission emission;
    emission.intensity = source.intensity;
    if (source.color.size() == 3)
        emission.color = {source.color[0], source.color[1], source.color[2]};
    light.type = source.type == "point"  ? CND_LIGHT_POINT
                 : source.type == "spot" ? CND_LIGHT_SPOT
                                         : CND_LIGHT_DIRECTIONAL;
    if (light.type != CND_LIGHT_POINT && !setDirection(placed.worldFromNode, light)) {
        document.warn(element, "is scaled to zero size by its node and is left out");
        return;
    }
    if (light.type == CND_LIGHT_SPOT)
        readCone(document, element, source.spot, light);
    const auto given = givenRadius(document, placed, json, element);
    if (light.type == CND_LIGHT_DIRECTIONAL) {
        if (given)
            document.warn(given->element, "has a radius, which directional lights do not use; "
                                          "--sun-radius gives them a size");
        if (options.sunRadius) {
            light.type = CND_LIGHT_DISTANT_SPHERE;
            light.radius = float(*options.sunRadius);
            // E = pi s^2 L
            emission.intensity /= pi * *options.sunRadius * *options.sunRadius;
        }
    } else if (given) {
        if (light.type == CND_LIGHT_SPOT)
            document.warn(given->element, "is a spot with a radius, so it becomes a disc, which "
                                          "has no cone: its light falls off with the cosine");
        giveRadius(document, given->element, given->metres, light, emission);
    } else if (light.type == CND_LIGHT_POINT && options.punctualRadius) {
        giveRadius(document, element, *options.punctualRadius, light, emission);
    }
    setEmission(document, element, emission, light);
    setInfluence(document, element, source.range, light);
    out.lights.push_back(light);
    out.positions.push_back(glm::dvec3(placed.worldFromNode[3]));
}

// Returns the unit normal of a node's xy plane on the side of the node's -z axis, whatever the
// node's transform. If z is scaled to 0, that side is unknown; the transform is then taken not to
// mirror.
glm::dvec3 facing(const glm::dmat4& worldFromNode)
{
    const glm::dvec3 x(worldFromNode[0]), y(worldFromNode[1]), z(worldFromNode[2]);
    const glm::dvec3 normal = glm::normalize(glm::cross(glm::normalize(x), glm::normalize(y)));
    return glm::dot(normal, z) < 0 ? normal : -normal;
}

// Reads the sides of a rect, which faces -z: its width lies along x, its height along y.
void setSides(const JsonValue& source, const glm::dmat4& worldFromNode, CndLight& light)
{
    light.type = CND_LIGHT_RECTANGLE;
    const auto side = [&](const char* key, const glm::dvec4& axis, float(&out)[3]) {
        const auto json = source.find(key);
        const double length = json ? json->number(NumberRange::positive(maxCoordinate)) : 1;
        assign(out, glm::vec3(0.5 * length * axis));
        if (!(glm::length(toGlm(out)) > 1e-15f))
            source.fail(std::string(key) + " is too small for single precision");
    };
    const glm::dvec3 x(worldFromNode[0]), y(worldFromNode[1]);
    // The rectangle faces along axisU x axisV: axisV is turned around if necessary.
    const bool alongY = glm::dot(glm::cross(x, y), facing(worldFromNode)) > 0;
    side("width", worldFromNode[0], light.axisU);
    side("height", alongY ? worldFromNode[1] : -worldFromNode[1], light.axisV);
    if (!(std::abs(glm::dot(glm::normalize(x), glm::normalize(y))) <= 0.99e-3))
        source.fail("is sheared by its node: its sides must be perpendicular");
}

void addArea(const GltfDocument& document, size_t index, const glm::dmat4& worldFromNode,
             GltfLights& out)
{
    const std::string element = "extensions.KHR_lights_area." + gltfElement("lights", index);
    const nlohmann::json& json =
        (*GltfDocument::extension(document.json, "KHR_lights_area"))["lights"][index];
    const JsonValue source(document.file, json, element);
    const auto shape = source.find("shape") ? source.find("shape") : source.find("type");
    if (!shape)
        source.fail("\"shape\" is missing");
    const std::string& name = shape->string();
    if (name != "sphere" && name != "rect" && name != "disk")
        shape->fail("must be sphere, disk or rect, is \"" + printable(name, 60) + "\"");
    const double scales[3] = {glm::length(glm::dvec3(worldFromNode[0])),
                              glm::length(glm::dvec3(worldFromNode[1])),
                              glm::length(glm::dvec3(worldFromNode[2]))};
    // Rects and disks lie in the xy plane, so the scale of z makes no difference to them.
    const double scale = name == "sphere" ? std::cbrt(scales[0] * scales[1] * scales[2])
                                          : std::sqrt(scales[0] * scales[1]);
    if (!(scale > 0)) {
        document.warn(element, "is scaled to zero size by its node and is left out");
        return;
    }
    CndLight light = {};
    Emission emission;
    if (const auto color = source.find("color"))
        emission.color = color->vector3({0});
    if (const auto intensity = source.find("intensity"))
        emission.intensity = intensity->number({0});
    if (name == "rect") {
        setSides(source, worldFromNode, light);
    } else {
        const bool disk = name == "disk";
        for (size_t i = 0; i < (disk ? 2 : 3); ++i)
            if (std::abs(scales[i] - scale) > 1e-3 * scale) {
                document.warn(element, "is scaled differently along its axes; it stays a " + name);
                break;
            }
        const auto radius = source.find("radius");
        light.type = disk ? CND_LIGHT_DISC : CND_LIGHT_SPHERE;
        setRadius(document, element, (radius ? radius->number() : 1) * scale, light);
        if (disk)
            assign(light.direction, glm::vec3(facing(worldFromNode)));
    }
    setEmission(document, element, emission, light);
    const auto range = source.find("range");
    setInfluence(document, element, range ? range->number() : 0, light);
    out.lights.push_back(light);
    out.positions.push_back(glm::dvec3(worldFromNode[3]));
}

} // namespace

void addGltfLights(const GltfDocument& document, const GltfPlacedNode& placed,
                   const SceneOptions& options, GltfLights& out)
{
    const nlohmann::json& json = document.json["nodes"][placed.node];
    try {
        if (const auto* extension = GltfDocument::extension(json, "KHR_lights_punctual"))
            addPunctual(document, (*extension)["light"].get<size_t>(), placed, options, out);
        if (const auto* extension = GltfDocument::extension(json, "KHR_lights_area"))
            addArea(document, (*extension)["light"].get<size_t>(), placed.worldFromNode, out);
    } catch (const SceneError& error) {
        document.warnInstead(error, "the light is left out");
    }
}

namespace
{

constexpr uint32_t lampBodyLayer = 1;

bool isInside(const glm::dvec3& p, const Bounds& box)
{
    return glm::all(glm::greaterThan(p, box.min)) && glm::all(glm::lessThan(p, box.max));
}

// Tells whether the triangles between these corners, three each, surround a point. Adds up their
// signed solid angles (Van Oosterom and Strackee 1983), which are 4 pi inside of a closed mesh and
// 0 outside.
bool surround(const std::vector<glm::dvec3>& corners, const glm::dvec3& point)
{
    double halfAngles = 0;
    for (size_t i = 0; i < corners.size(); i += 3) {
        const glm::dvec3 a = corners[i] - point, b = corners[i + 1] - point,
                         c = corners[i + 2] - point;
        const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
        halfAngles += std::atan2(glm::dot(a, glm::cross(b, c)), la * lb * lc + glm::dot(a, b) * lc +
                                                                    glm::dot(b, c) * la +
                                                                    glm::dot(c, a) * lb);
    }
    return std::abs(halfAngles) > std::numbers::pi;
}

std::vector<glm::dvec3> cornersOf(const Mesh& mesh, const glm::dmat4& worldFromObject)
{
    std::vector<glm::dvec3> out;
    for (const uint32_t index : mesh.indices)
        out.emplace_back(worldFromObject * glm::dvec4(mesh.vertices[index].position, 1));
    return out;
}

} // namespace

void findLampBodies(Scene& scene, const std::vector<glm::dvec3>& positions)
{
    if (positions.empty())
        return;
    for (Instance& instance : scene.instances) {
        const Material& material = scene.materials[instance.material];
        if (material.unlit || material.emission == glm::vec3(0))
            continue;
        const std::vector<glm::dvec3> corners =
            cornersOf(scene.meshes[instance.mesh], instance.worldFromObject);
        if (corners.empty())
            continue;
        Bounds box{corners[0], corners[0]};
        for (const glm::dvec3& corner : corners)
            box = {glm::min(box.min, corner), glm::max(box.max, corner)};
        for (size_t i = 0; i < positions.size(); ++i)
            if (!cndIsDistant(scene.lights[i].type) && isInside(positions[i], box) &&
                surround(corners, positions[i])) {
                instance.occluderLayer = lampBodyLayer;
                scene.lights[i].unshadowedBy |= 1u << lampBodyLayer;
            }
    }
}

} // namespace candelabra::app
