// SPDX-License-Identifier: Apache-2.0
// Tests the scene description of the reference images: values arrive as written, errors name the
// element.
#include <cmath>

#include <gtest/gtest.h>

#include "load/load.h"
#include "scene/scene_error.h"
#include "unit/gltf_builder.h"
#include "unit/scene_invariants.h"

namespace candelabra::test
{

namespace
{

using namespace candelabra::app;

Json validScene()
{
    return Json::parse(R"({
        "name": "two balls", "about": "x", "channels": 3, "references": {}, "rendered_terms": ["D"],
        "camera": {"position": [0, 2, 4], "look_at": [0, 0, 0], "up": [0, 1, 0],
                   "vertical_fov_degrees": 45, "aspect": 1.5},
        "object": {"type": "plane", "point": [0, 1, 0], "normal": [0, 2, 0]},
        "material": {"albedo": [0.8, 0.6, 0.4], "diffuse": true, "specular": true,
                     "F0": [0.04, 0.05, 0.06], "alpha": 0.09, "perceptual_roughness": 0.3,
                     "metalness": 0.25},
        "lights": [{"position": [0, 3, 1], "radius": 0.5, "radiance": [10, 20, 30]}],
        "resolution": [256, 128], "background": [0, 0.5, 1],
        "lights_visible_to_camera": false, "lights_occlude": false})");
}

class SceneJson : public testing::Test
{
protected:
    Scene load(const Json& json)
    {
        Scene scene = loadScene(folder_.write("scene.json", json.dump()), {});
        EXPECT_EQ(brokenInvariant(scene), "");
        return scene;
    }

    // Returns the error message without the file's folder.
    std::string error(const Json& json)
    {
        const std::string file = folder_.write("scene.json", json.dump());
        try {
            loadScene(file, {});
        } catch (const SceneError& e) {
            const std::string message = e.what();
            EXPECT_EQ(message.find(file), 0u) << message;
            return message.substr(file.size() - std::string("scene.json").size());
        }
        return "no error";
    }

    TemporaryFolder folder_;
};

TEST_F(SceneJson, ReadsEveryField)
{
    const Scene scene = load(validScene());
    EXPECT_EQ(scene.name, "two balls");
    ASSERT_EQ(scene.cameras.size(), 1u);
    const Camera& camera = scene.cameras[0];
    EXPECT_EQ(camera.position, glm::dvec3(0, 2, 4));
    EXPECT_NEAR(glm::distance(camera.forward, glm::dvec3(0, -2, -4) / std::sqrt(20.0)), 0, 1e-15);
    EXPECT_NEAR(glm::distance(camera.up, glm::dvec3(0, 4, -2) / std::sqrt(20.0)), 0, 1e-15);
    EXPECT_NEAR(camera.verticalFov, std::acos(-1.0) / 4, 1e-15);
    EXPECT_EQ(camera.aspect, 1.5);
    EXPECT_EQ(camera.farPlane, 0);
    ASSERT_EQ(scene.analyticObjects.size(), 1u);
    EXPECT_EQ(scene.analyticObjects[0].type, AnalyticObject::Type::Plane);
    EXPECT_EQ(scene.analyticObjects[0].point, glm::dvec3(0, 1, 0));
    EXPECT_EQ(scene.analyticObjects[0].normal, glm::dvec3(0, 1, 0));
    ASSERT_EQ(scene.lights.size(), 1u);
    const CndLight& light = scene.lights[0];
    EXPECT_EQ(light.type, uint32_t{CND_LIGHT_SPHERE});
    EXPECT_EQ(light.position[1], 3);
    EXPECT_EQ(light.radius, 0.5f);
    EXPECT_EQ(light.emission[2], 30);
    EXPECT_TRUE(std::isinf(light.influenceRadius));
    EXPECT_EQ(scene.resolution, glm::uvec2(256, 128));
    EXPECT_EQ(scene.background, glm::vec3(0, 0.5f, 1));
    EXPECT_FALSE(scene.lightsVisible);
    EXPECT_TRUE(scene.warnings.empty());
}

TEST_F(SceneJson, MaterialKeepsDiffuseAlbedoAndFinalF0)
{
    const Material m = load(validScene()).materials.at(0);
    // diffuse albedo = baseColor (1 - metalness) diffuseWeight = 0.75 albedo
    for (int i = 0; i < 3; ++i)
        EXPECT_FLOAT_EQ(m.baseColor[i] * (1 - m.metalness) * m.diffuseWeight,
                        0.75f * (0.8f - 0.2f * static_cast<float>(i)));
    // F0 = mix(dielectricF0, baseColor, metalness)
    EXPECT_EQ(glm::mix(m.dielectricF0, m.baseColor, m.metalness), glm::vec3(0.04f, 0.05f, 0.06f));
    EXPECT_FLOAT_EQ(m.perceptualRoughness, 0.3f);
    EXPECT_EQ(m.specularWeight, 1);

    Json json = validScene();
    json["material"]["specular"] = false;
    json["material"]["diffuse"] = false;
    const Material dark = load(json).materials.at(0);
    EXPECT_EQ(dark.specularWeight, 0);
    EXPECT_EQ(dark.diffuseWeight, 0);
}

TEST_F(SceneJson, SeveralObjectsWithTheirOwnMaterials)
{
    Json json = validScene();
    json.erase("object");
    json["objects"] = Json::parse(R"([
        {"type": "sphere", "center": [1, 2, 3], "radius": 0.5},
        {"type": "plane", "point": [0, 0, 0], "normal": [1, 0, 0],
         "material": {"albedo": [1, 0, 0], "alpha": 1}}])");
    const Scene scene = load(json);
    ASSERT_EQ(scene.analyticObjects.size(), 2u);
    EXPECT_EQ(scene.analyticObjects[0].type, AnalyticObject::Type::Ball);
    EXPECT_EQ(scene.analyticObjects[0].radius, 0.5);
    EXPECT_EQ(scene.analyticObjects[0].point, glm::dvec3(1, 2, 3));
    EXPECT_EQ(scene.analyticObjects[0].material, 0u);
    EXPECT_EQ(scene.analyticObjects[1].material, 1u);
    EXPECT_EQ(scene.materials.at(1).baseColor, glm::vec3(1, 0, 0));
}

TEST_F(SceneJson, LightsFarAwayKeepTheirDistances)
{
    Json json = validScene();
    json["lights"] = Json::parse(R"([
        {"position": [1e7, 0, 0], "radius": 0.1, "radiance": [1, 1, 1]},
        {"position": [10000000.25, 0, 0], "radius": 0.1, "radiance": [1, 1, 1],
         "influence_radius": 5}])");
    const Scene scene = load(json);
    for (size_t i = 0; i < 2; ++i)
        EXPECT_EQ(scene.lightOrigin.x + static_cast<double>(scene.lights[i].position[0]),
                  1e7 + 0.25 * static_cast<double>(i));
    EXPECT_EQ(scene.lights[1].influenceRadius, 5);
}

TEST_F(SceneJson, OccludingLightsAreAnnounced)
{
    Json json = validScene();
    json["lights_occlude"] = true;
    json["lights_visible_to_camera"] = true;
    const Scene scene = load(json);
    ASSERT_EQ(scene.warnings.size(), 1u);
    EXPECT_NE(scene.warnings[0].find("lights_occlude"), std::string::npos);
    EXPECT_TRUE(scene.lightsVisible);
}

struct ErrorCase {
    const char* pointer; // where to put `value`
    const char* value;   // JSON, or "" to remove the key
    const char* message;
};

class SceneJsonError : public SceneJson, public testing::WithParamInterface<ErrorCase>
{
};

TEST_P(SceneJsonError, NamesElementAndReason)
{
    const ErrorCase& c = GetParam();
    Json json = validScene();
    const Json::json_pointer pointer(c.pointer);
    if (*c.value)
        json[pointer] = Json::parse(c.value);
    else
        json[pointer.parent_pointer()].erase(pointer.back());
    EXPECT_EQ(error(json), c.message);
}

INSTANTIATE_TEST_SUITE_P(
    Table, SceneJsonError,
    testing::Values(
        ErrorCase{"/lights/0/radius", "-1", "scene.json: lights[0].radius: must be > 0, is -1"},
        ErrorCase{"/lights/0/radius", "\"1\"",
                  "scene.json: lights[0].radius: must be a number, is \"1\""},
        ErrorCase{"/lights/0/radius", "", "scene.json: lights[0]: \"radius\" is missing"},
        ErrorCase{"/lights/0/radius", "1e-60",
                  "scene.json: lights[0].radius: is too small for single precision"},
        ErrorCase{"/lights/0/influence_radius", "0.5",
                  "scene.json: lights[0].influence_radius: must be greater than radius"},
        ErrorCase{
            "/lights/0/radiance", "[1, 2]",
            "scene.json: lights[0].radiance: must be an array of 3 numbers, is an array of 2"},
        ErrorCase{"/lights/0/radiance/1", "-3",
                  "scene.json: lights[0].radiance[1]: must be >= 0, is -3"},
        ErrorCase{"/lights/0/colour", "1",
                  "scene.json: lights[0]: unknown key \"colour\"; the known ones are type, layers, "
                  "unshadowed, unshadowed_by, position, radius, influence_radius, radiance, "
                  "luminance, luminous_power, intensity"},
        ErrorCase{"/lights", "{}", "scene.json: lights: must be an array, is an object"},
        ErrorCase{"/light", "[]",
                  "scene.json: unknown key \"light\"; the known ones are camera, object, objects, "
                  "material, source, lights, resolution, background, lights_visible_to_camera, "
                  "lights_occlude, exposure_compensation, name, about, channels, references, "
                  "rendered_terms"},
        ErrorCase{"/camera", "", "scene.json: \"camera\" is missing"},
        ErrorCase{"/camera/look_at", "[0, 2, 4]",
                  "scene.json: camera.look_at: must not be the camera's position"},
        ErrorCase{"/camera/up", "[0, 1, 2]",
                  "scene.json: camera.up: must not be parallel to the viewing direction"},
        ErrorCase{"/camera/up", "[0, 0, 0]", "scene.json: camera.up: must not be zero"},
        ErrorCase{"/camera/vertical_fov_degrees", "180",
                  "scene.json: camera.vertical_fov_degrees: must be > 0 and <= 179.9, is 180"},
        ErrorCase{"/camera/position/0", "null",
                  "scene.json: camera.position[0]: must be a number, is null"},
        ErrorCase{"/object/type", "\"torus\"",
                  "scene.json: object.type: must be \"plane\" or \"sphere\", is \"torus\""},
        ErrorCase{"/object/radius", "1",
                  "scene.json: object: unknown key \"radius\"; the known ones are type, point, "
                  "normal, material, occluder_layer"},
        ErrorCase{"/objects", "[]", "scene.json: objects: cannot be combined with \"object\""},
        ErrorCase{"/material/albedo/2", "1.5",
                  "scene.json: material.albedo[2]: must be between 0 and 1, is 1.5"},
        ErrorCase{"/material/alpha", "0.1",
                  "scene.json: material.perceptual_roughness: must be the square root of alpha"},
        ErrorCase{"/material/diffuse", "1",
                  "scene.json: material.diffuse: must be true or false, is 1"},
        ErrorCase{"/material", "",
                  "scene.json: object: has no \"material\", and neither has the scene"},
        ErrorCase{"/resolution", "[256, 0]",
                  "scene.json: resolution[1]: must be an integer between 1 and 16384, is 0"},
        ErrorCase{"/resolution", "[256.5, 1]",
                  "scene.json: resolution[0]: must be an integer between 1 and 16384, is 256.5"},
        ErrorCase{"/resolution", "[18446744073709551615, 1]",
                  "scene.json: resolution[0]: must be an integer between 1 and 16384, is "
                  "18446744073709551615"},
        ErrorCase{"/resolution", "[256]", "scene.json: resolution: must be [width, height]"},
        ErrorCase{"/background", "[0, 0, -1]", "scene.json: background[2]: must be >= 0, is -1"}));

TEST_F(SceneJson, ErrorsOfTheWholeFile)
{
    EXPECT_EQ(error(Json::array()), "scene.json: must be an object, is an array of 0");
    Json json = validScene();
    json["material"].erase("alpha");
    EXPECT_EQ(load(json).materials.at(0).perceptualRoughness, 0.3f);
    json["material"].erase("perceptual_roughness");
    EXPECT_EQ(error(json),
              "scene.json: material: \"alpha\" or \"perceptual_roughness\" is missing");
}

} // namespace

} // namespace candelabra::test
