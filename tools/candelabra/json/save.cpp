// SPDX-License-Identifier: Apache-2.0
#include "json/save.h"

#include <cmath>
#include <filesystem>
#include <numbers>

#include <nlohmann/json.hpp>

#include "candelabra/glm.hpp"
#include "generate/generators.h"
#include "scene/light_types.h"
#include "scene/scene_error.h"

namespace candelabra::app
{

namespace
{

using Json = nlohmann::ordered_json;

constexpr double degreesPerRadian = 180 / std::numbers::pi;

Json toJson(const glm::dvec3& v)
{
    return {v.x, v.y, v.z};
}

// Adds the numbers of the layers as the loader reads them. Nothing is added for a mask of 0.
void addLayers(Json& json, uint32_t layers, const char* key = "layers")
{
    for (uint32_t i = 0; i < CND_LAYER_COUNT; ++i)
        if (layers & 1u << i)
            json[key].push_back(i);
}

Json cameraJson(const Camera& camera)
{
    if (camera.orthographic)
        throw SceneError(
            "the scene cannot be saved: scene descriptions have no orthographic cameras");
    Json out{{"position", toJson(camera.position)},
             {"look_at", toJson(camera.position + camera.forward)},
             {"up", toJson(camera.up)},
             {"vertical_fov_degrees", camera.verticalFov * degreesPerRadian}};
    if (camera.aspect)
        out["aspect"] = *camera.aspect;
    addLayers(out, camera.layers);
    return out;
}

Json materialJson(const Material& m)
{
    if (!(m.perceptualRoughness > 0))
        throw SceneError("the scene cannot be saved: scene descriptions have no roughness of 0; "
                         "choose a greater one");
    // In the format every material is a dielectric and its F0 is used as it is, so metalness is
    // mixed into F0 and albedo here.
    const glm::dvec3 base(m.baseColor), f0(m.dielectricF0);
    const double metalness = m.metalness;
    return {{"name", m.name},
            {"albedo", toJson((1 - metalness) * base)},
            {"F0", toJson(glm::mix(f0, base, metalness))},
            {"perceptual_roughness", m.perceptualRoughness},
            {"diffuse", m.diffuseWeight != 0},
            {"specular", m.specularWeight != 0}};
}

Json objectsJson(const Scene& scene)
{
    Json out = Json::array();
    for (const AnalyticObject& o : scene.analyticObjects) {
        Json object =
            o.type == AnalyticObject::Type::Plane
                ? Json{{"type", "plane"}, {"point", toJson(o.point)}, {"normal", toJson(o.normal)}}
                : Json{{"type", "sphere"}, {"center", toJson(o.point)}, {"radius", o.radius}};
        if (o.occluderLayer)
            object["occluder_layer"] = o.occluderLayer;
        object["material"] = materialJson(scene.materials[o.material]);
        out.push_back(object);
    }
    return out;
}

Json keyJson(const CndLight& light, const glm::dvec3& centre, LightKeyMeaning meaning)
{
    const glm::dvec3 u(toGlm(light.axisU)), v(toGlm(light.axisV));
    switch (meaning) {
    case LightKeyMeaning::Position:
        return toJson(centre);
    case LightKeyMeaning::Direction:
        return toJson(toGlm(light.direction));
    case LightKeyMeaning::Radius:
    case LightKeyMeaning::Sine:
        return light.radius;
    case LightKeyMeaning::SegmentStart:
        return toJson(centre - u);
    case LightKeyMeaning::SegmentEnd:
        return toJson(centre + u);
    case LightKeyMeaning::AxisU:
        return toJson(u);
    case LightKeyMeaning::AxisV:
        return toJson(v);
    case LightKeyMeaning::InnerCone:
        return double(light.innerConeAngle) * degreesPerRadian;
    case LightKeyMeaning::OuterCone:
        return double(light.outerConeAngle) * degreesPerRadian;
    case LightKeyMeaning::TwoSided:
        return light.twoSided != 0;
    case LightKeyMeaning::Corners: {
        Json corners = Json::array();
        for (uint32_t i = 0; i < light.polygon->cornerCount; ++i) {
            const float(&corner)[2] = light.polygon->corners[i];
            corners.push_back(toJson(centre + double(corner[0]) * u + double(corner[1]) * v));
        }
        return corners;
    }
    }
    return {};
}

Json lightJson(const CndLight& light, const glm::dvec3& origin)
{
    const LightTypeInfo& type = lightTypeInfo(light.type);
    Json out{{"type", type.name}};
    for (const LightKey& key : type.keys)
        out[key.name] = keyJson(light, origin + glm::dvec3(toGlm(light.position)), key.meaning);
    out[type.emission.front()] = toJson(toGlm(light.emission));
    if (!cndIsDistant(light.type) && std::isfinite(light.influenceRadius))
        out["influence_radius"] = light.influenceRadius;
    addLayers(out, light.layers);
    if (light.unshadowed)
        out["unshadowed"] = true;
    addLayers(out, light.unshadowedBy, "unshadowed_by");
    return out;
}

// The path of `file` relative to `folder`, so that both can be moved together; the absolute path if
// there is no relative one.
std::string fileSeenFrom(const std::string& folder, const std::string& file)
{
    namespace fs = std::filesystem;
    std::error_code unknown;
    const fs::path relative = fs::relative(file, folder.empty() ? "." : folder, unknown);
    return (unknown || relative.empty() ? fs::absolute(file) : relative).generic_string();
}

Json sourceJson(const SceneSource& source, const std::string& path)
{
    const std::string folder = std::filesystem::path(path).parent_path().string();
    Json out{{"scene", isBuiltIn(source.scene) ? source.scene : fileSeenFrom(folder, source.scene)},
             {"seed", source.seed}};
    const MaterialOverride& m = source.materials;
    if (m.on)
        out["material"] = {{"perceptual_roughness", m.perceptualRoughness},
                           {"metalness", m.metalness}};
    return out;
}

} // namespace

void overrideMaterials(std::vector<Material>& materials, const MaterialOverride& override)
{
    if (!override.on)
        return;
    for (Material& material : materials) {
        material.perceptualRoughness = override.perceptualRoughness;
        material.metalness = override.metalness;
        material.metallicRoughnessTexture = {};
    }
}

std::string sceneDescription(const Scene& scene, const SceneSource& source, const Camera& camera,
                             double time, const std::string& path)
{
    Json out{{"name", scene.name}, {"camera", cameraJson(camera)}};
    if (scene.instances.empty())
        out["objects"] = objectsJson(scene);
    else
        out["source"] = sourceJson(source, path);
    std::vector<CndLight> lights;
    lightsAtTime(scene, time, lights);
    out["lights"] = Json::array();
    for (const CndLight& light : lights)
        out["lights"].push_back(lightJson(light, scene.lightOrigin));
    if (scene.resolution)
        out["resolution"] = {scene.resolution->x, scene.resolution->y};
    if (scene.exposureCompensation != 0)
        out["exposure_compensation"] = scene.exposureCompensation;
    out["background"] = toJson(glm::dvec3(scene.background));
    out["lights_visible_to_camera"] = scene.lightsVisible;
    return out.dump(2, ' ', true, Json::error_handler_t::replace) + "\n";
}

} // namespace candelabra::app
