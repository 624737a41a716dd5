// SPDX-License-Identifier: Apache-2.0
// Reads scene descriptions, the small format in which reference images are published: one camera,
// exact planes and balls, and lights (scene_json_lights.h). tools/SCENE_JSON.md describes all keys.
#include <cmath>
#include <filesystem>
#include <numbers>

#include "generate/generators.h"
#include "gltf/gltf.h"
#include "scene/json_value.h"
#include "scene/scene_file.h"
#include "json/save.h"
#include "json/scene_json.h"
#include "json/scene_json_lights.h"

namespace candelabra::app
{

namespace
{

constexpr NumberRange unitInterval{0, 1};

glm::vec3 color(const JsonValue& value, const NumberRange& range)
{
    return glm::vec3(value.vector3(range));
}

// Reads a vector and gives it unit length. Vectors not longer than 1e-6 count as zero.
glm::dvec3 direction(const JsonValue& value)
{
    const glm::dvec3 v = value.vector3(coordinate);
    if (!(glm::length(v) > 1e-6))
        value.fail("must not be zero");
    return glm::normalize(v);
}

Camera readCamera(const JsonValue& json)
{
    json.refuseOtherKeys({"position", "look_at", "up", "vertical_fov_degrees", "aspect", "layers"});
    Camera camera;
    camera.name = "scene camera";
    camera.position = json.member("position").vector3(coordinate);
    const glm::dvec3 toTarget = json.member("look_at").vector3(coordinate) - camera.position;
    if (!(glm::length(toTarget) > 1e-6))
        json.member("look_at").fail("must not be the camera's position");
    camera.forward = glm::normalize(toTarget);
    const glm::dvec3 right = glm::cross(camera.forward, direction(json.member("up")));
    if (!(glm::length(right) > 1e-6))
        json.member("up").fail("must not be parallel to the viewing direction");
    camera.up = glm::cross(glm::normalize(right), camera.forward);
    const JsonValue fov = json.member("vertical_fov_degrees");
    const double degrees = fov.number(NumberRange::positive(179.9));
    camera.verticalFov = degrees * std::numbers::pi / 180;
    if (const auto aspect = json.find("aspect"))
        camera.aspect = aspect->number({1e-3, 1e3});
    if (const auto layers = json.find("layers"))
        camera.layers = readLayers(*layers);
    // The cameras of the format see everything in front of them. The renderer needs a near plane:
    // what is nearer than this is not shown.
    camera.nearPlane = 1e-3;
    return camera;
}

float readPerceptualRoughness(const JsonValue& json)
{
    const auto alphaJson = json.find("alpha");
    const auto roughnessJson = json.find("perceptual_roughness");
    if (!alphaJson && !roughnessJson)
        json.fail("\"alpha\" or \"perceptual_roughness\" is missing");
    if (!alphaJson)
        return float(roughnessJson->number(NumberRange::positive(1)));
    const double fromAlpha = std::sqrt(alphaJson->number(NumberRange::positive(1)));
    if (roughnessJson) {
        const double roughness = roughnessJson->number(NumberRange::positive(1));
        if (!(std::abs(roughness - fromAlpha) <= 1e-6))
            roughnessJson->fail("must be the square root of alpha");
    }
    return float(fromAlpha);
}

// The F0 of the file is used as it is, while a Material mixes its F0 with its base colour according
// to its metalness. So the Material is always a dielectric, and the metalness of the file only
// scales its base colour.
Material readMaterial(const JsonValue& json)
{
    json.refuseOtherKeys({"name", "albedo", "diffuse", "specular", "F0", "reflectance", "alpha",
                          "perceptual_roughness", "metalness"});
    Material material;
    if (const auto name = json.find("name"))
        material.name = name->string();
    const auto metalnessJson = json.find("metalness");
    const double metalness = metalnessJson ? metalnessJson->number(unitInterval) : 0;
    const glm::dvec3 albedo = json.member("albedo").vector3(unitInterval);
    material.baseColor = glm::vec3((1 - metalness) * albedo);
    material.metalness = 0;
    material.perceptualRoughness = readPerceptualRoughness(json);
    if (const auto f0 = json.find("F0"))
        material.dielectricF0 = color(*f0, unitInterval);
    if (const auto reflectance = json.find("reflectance")) {
        if (json.find("F0"))
            reflectance->fail("cannot be combined with \"F0\"");
        // Lagarde and de Rousiers 2014, eq. 25. A common dielectric has a reflectance of 0.5, which
        // is an F0 of 0.04.
        const double r = reflectance->number(unitInterval);
        material.dielectricF0 = glm::vec3(float(0.16 * r * r));
    }
    const auto diffuse = json.find("diffuse");
    const auto specular = json.find("specular");
    material.diffuseWeight = diffuse && !diffuse->boolean() ? 0.0f : 1.0f;
    if (specular && !specular->boolean()) {
        material.specularWeight = 0;
        material.dielectricF0 = glm::vec3(0); // a weight of 0 alone leaves F0 (1 - (1 - VoH)^5)
    }
    return material;
}

AnalyticObject readObject(const JsonValue& json)
{
    AnalyticObject object;
    const JsonValue type = json.member("type");
    if (type.string() == "plane") {
        json.refuseOtherKeys({"type", "point", "normal", "material", "occluder_layer"});
        object.type = AnalyticObject::Type::Plane;
        object.point = json.member("point").vector3(coordinate);
        object.normal = direction(json.member("normal"));
    } else if (type.string() == "sphere") {
        json.refuseOtherKeys({"type", "center", "radius", "material", "occluder_layer"});
        object.type = AnalyticObject::Type::Ball;
        object.point = json.member("center").vector3(coordinate);
        object.radius = json.member("radius").number(NumberRange::positive(maxCoordinate));
    } else {
        type.fail("must be \"plane\" or \"sphere\", is \"" + printable(type.string(), 60) + "\"");
    }
    if (const auto layer = json.find("occluder_layer"))
        object.occluderLayer = uint32_t(layer->integer(0, CND_OCCLUDER_LAYER_COUNT - 1));
    return object;
}

// Reads "object", or our extension "objects". An object has its own "material" or uses the one of
// the scene.
void readObjects(const JsonValue& root, Scene& scene)
{
    const auto common = root.find("material");
    if (common)
        scene.materials.push_back(readMaterial(*common));
    const auto add = [&](const JsonValue& json) {
        AnalyticObject object = readObject(json);
        if (const auto own = json.find("material")) {
            object.material = uint32_t(scene.materials.size());
            scene.materials.push_back(readMaterial(*own));
        } else if (!common) {
            json.fail("has no \"material\", and neither has the scene");
        }
        scene.analyticObjects.push_back(object);
    };
    const auto list = root.find("objects");
    if (!list) {
        add(root.member("object"));
        return;
    }
    if (root.find("object"))
        list->fail("cannot be combined with \"object\"");
    list->requireArray();
    if (list->size() == 0)
        list->fail("must not be empty");
    for (size_t i = 0; i < list->size(); ++i)
        add(list->item(i));
}

float readShare(const JsonValue& json, const char* key)
{
    return float(json.member(key).number(unitInterval));
}

// Reads "source". A path in it is relative to the folder of the description at `path`.
SceneSource readSource(const JsonValue& json, const std::string& path)
{
    json.refuseOtherKeys({"scene", "seed", "material"});
    const JsonValue name = json.member("scene");
    SceneSource out{.scene = name.string()};
    if (const auto seed = json.find("seed"))
        out.seed = uint32_t(seed->integer(0, UINT32_MAX));
    if (const auto material = json.find("material")) {
        material->refuseOtherKeys({"perceptual_roughness", "metalness"});
        out.materials = {true, readShare(*material, "perceptual_roughness"),
                         readShare(*material, "metalness")};
    }
    if (isBuiltIn(out.scene))
        return out;
    out.scene = (std::filesystem::path(path).parent_path() / out.scene).string();
    if (!isGltf(out.scene))
        name.fail("must be hall, field, fence, rooms, showcase, or a glTF file, is \"" +
                  printable(name.string(), 60) + "\"");
    return out;
}

// Loads or generates the source and removes its lights and cameras.
Scene loadSource(const SceneSource& source)
{
    SceneOptions options{.seed = source.seed};
    if (isGenerated(source.scene)) // for a file, the option is the number of lights to add
        options.lights = 0;
    Scene out = isBuiltIn(source.scene) ? generateScene(source.scene, options)
                                        : loadGltf(source.scene, options);
    overrideMaterials(out.materials, source.materials);
    out.lights.clear();
    out.lightMotions.clear();
    out.lightOrigin = glm::dvec3(0);
    out.cameras.clear();
    return out;
}

nlohmann::json readDocument(const std::string& path)
{
    const std::vector<uint8_t> bytes = readSceneFile(path);
    return parseSceneJson(
        path, std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
}

glm::uvec2 readResolution(const JsonValue& json)
{
    json.requireArray();
    if (json.size() != 2)
        json.fail("must be [width, height]");
    return {uint32_t(json.item(0).integer(1, 16384)), uint32_t(json.item(1).integer(1, 16384))};
}

} // namespace

SceneSource sceneSource(const std::string& scene, uint32_t seed)
{
    if (isBuiltIn(scene) || isGltf(scene))
        return {scene, seed};
    const nlohmann::json document = readDocument(scene);
    const auto source = JsonValue(scene, document).find("source");
    return source ? readSource(*source, scene) : SceneSource{scene, seed};
}

Scene loadSceneJson(const std::string& path)
{
    const nlohmann::json document = readDocument(path);
    const JsonValue root(path, document);
    root.refuseOtherKeys({"camera", "object", "objects", "material", "source", "lights",
                          "resolution", "background", "lights_visible_to_camera", "lights_occlude",
                          "exposure_compensation",
                          // for people who read the file, not used:
                          "name", "about", "channels", "references", "rendered_terms"});
    Scene scene;
    const auto source = root.find("source");
    if (source) {
        for (const char* key : {"object", "objects", "material"})
            if (root.find(key))
                source->fail(std::string("cannot be combined with \"") + key + "\"");
        scene = loadSource(readSource(*source, path));
    } else {
        scene.lobes = CND_LOBES_SUM; // the format has the two-lobe materials of path tracers
    }
    const auto name = root.find("name");
    scene.name = name && name->json().is_string() ? name->string()
                                                  : std::filesystem::path(path).stem().string();
    scene.cameras.push_back(readCamera(root.member("camera")));
    if (!source)
        readObjects(root, scene);
    readSceneLights(root.member("lights"), scene);
    if (const auto resolution = root.find("resolution"))
        scene.resolution = readResolution(*resolution);
    if (const auto background = root.find("background"))
        scene.background = color(*background, {0});
    // The night of a source need not be one under other lights.
    const auto compensation = root.find("exposure_compensation");
    scene.exposureCompensation = compensation ? float(compensation->number({-20, 20})) : 0;
    const auto visible = root.find("lights_visible_to_camera");
    scene.lightsVisible = visible && visible->boolean();
    const auto occlude = root.find("lights_occlude");
    if (occlude && occlude->boolean())
        scene.warnings.push_back(path +
                                 ": lights_occlude is ignored: lights never block light here");
    return scene;
}

} // namespace candelabra::app
