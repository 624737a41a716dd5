// SPDX-License-Identifier: Apache-2.0
// Tests that scenes are the same after saving and loading.
#include <filesystem>

#include <gtest/gtest.h>

#include "harness/paths.h"
#include "load/load.h"
#include "scene/light_types.h"
#include "scene/scene_error.h"
#include "unit/gltf_builder.h"
#include "unit/scene_invariants.h"
#include "json/save.h"
#include "json/scene_json.h"

namespace candelabra::test
{

namespace
{

using namespace candelabra::app;

class Save : public testing::Test
{
protected:
    Scene again(const Scene& scene, const SceneSource& source, double time = 0)
    {
        const std::string path = folder_.path("saved.json");
        folder_.write("saved.json", sceneDescription(scene, source, scene.cameras[0], time, path));
        Scene out = loadScene(path, {});
        EXPECT_EQ(brokenInvariant(out), "");
        return out;
    }
    std::string refusal(const std::string& json)
    {
        try {
            loadScene(folder_.write("scene.json", json), {});
        } catch (const SceneError& error) {
            return error.what();
        }
        return "none";
    }

    TemporaryFolder folder_;
};

// Changes the working folder until the end of the scope.
class WorkingFolder
{
public:
    explicit WorkingFolder(const std::string& path) { std::filesystem::current_path(path); }
    ~WorkingFolder() { std::filesystem::current_path(before_); }
    WorkingFolder(const WorkingFolder&) = delete;
    WorkingFolder& operator=(const WorkingFolder&) = delete;

private:
    std::filesystem::path before_ = std::filesystem::current_path();
};

// Tolerance: directions are normalised again and angles are converted through degrees, both in
// single precision.
void expectSameVector(const float (&a)[3], const float (&b)[3], const std::string& what)
{
    for (int i = 0; i < 3; ++i)
        EXPECT_NEAR(a[i], b[i], 2e-7f * std::max(1.0f, std::abs(a[i]))) << what;
}

glm::dvec3 worldPositionOf(const Scene& scene, const CndLight& light)
{
    return scene.lightOrigin + glm::dvec3(light.position[0], light.position[1], light.position[2]);
}

glm::dvec3 cornerOf(const Scene& scene, const CndLight& light, uint32_t i)
{
    const float(&corner)[2] = light.polygon->corners[i];
    return worldPositionOf(scene, light) +
           double(corner[0]) * glm::dvec3(light.axisU[0], light.axisU[1], light.axisU[2]) +
           double(corner[1]) * glm::dvec3(light.axisV[0], light.axisV[1], light.axisV[2]);
}

void expectSameLights(const Scene& a, const Scene& b)
{
    ASSERT_EQ(a.lights.size(), b.lights.size());
    for (size_t i = 0; i < a.lights.size(); ++i) {
        const CndLight &x = a.lights[i], &y = b.lights[i];
        const std::string what = "light " + std::to_string(i);
        ASSERT_EQ(x.type, y.type) << what;
        EXPECT_EQ(x.layers, y.layers) << what;
        EXPECT_EQ(x.unshadowed, y.unshadowed) << what;
        EXPECT_EQ(x.unshadowedBy, y.unshadowedBy) << what;
        expectSameVector(x.emission, y.emission, what);
        const uint32_t fields = cndLightFields(x.type);
        if (fields & CND_LIGHT_FIELD_POLYGON_BIT) {
            // The axes may be those of another rectangle around the same polygon.
            ASSERT_EQ(x.polygon->cornerCount, y.polygon->cornerCount) << what;
            for (uint32_t k = 0; k < x.polygon->cornerCount; ++k)
                EXPECT_LT(glm::distance(cornerOf(a, x, k), cornerOf(b, y, k)), 1e-6) << what;
            EXPECT_EQ(x.twoSided, y.twoSided) << what;
            EXPECT_EQ(x.influenceRadius, y.influenceRadius) << what;
            continue;
        }
        if (fields & CND_LIGHT_FIELD_POSITION_BIT) {
            const glm::dvec3 at = worldPositionOf(a, x), gap = at - worldPositionOf(b, y);
            EXPECT_LT(glm::length(gap), 1e-6 * std::max(1.0, glm::length(at))) << what;
            EXPECT_EQ(x.influenceRadius, y.influenceRadius) << what;
        }
        if (fields & CND_LIGHT_FIELD_AXIS_U_BIT)
            expectSameVector(x.axisU, y.axisU, what);
        if (fields & CND_LIGHT_FIELD_AXIS_V_BIT)
            expectSameVector(x.axisV, y.axisV, what);
        if (fields & CND_LIGHT_FIELD_TWO_SIDED_BIT) {
            EXPECT_EQ(x.twoSided, y.twoSided) << what;
        }
        if (fields & CND_LIGHT_FIELD_CONE_BIT) {
            EXPECT_FLOAT_EQ(x.innerConeAngle, y.innerConeAngle) << what;
            EXPECT_FLOAT_EQ(x.outerConeAngle, y.outerConeAngle) << what;
        }
        if (fields & CND_LIGHT_FIELD_DIRECTION_BIT)
            expectSameVector(x.direction, y.direction, what);
        if (fields & CND_LIGHT_FIELD_RADIUS_BIT) {
            EXPECT_EQ(x.radius, y.radius) << what;
        }
    }
}

void expectSameCamera(const Camera& a, const Camera& b)
{
    EXPECT_LT(glm::length(a.position - b.position), 1e-9);
    EXPECT_LT(glm::length(a.forward - b.forward), 1e-9);
    EXPECT_LT(glm::length(a.up - b.up), 1e-9);
    EXPECT_NEAR(a.verticalFov, b.verticalFov, 1e-12);
    EXPECT_EQ(a.aspect, b.aspect);
    EXPECT_EQ(a.layers, b.layers);
}

} // namespace

// Also types that the data file does not have.
TEST_F(Save, LightsOfEveryType)
{
    Scene scene = loadSceneJson(dataPath("every_light.json"));
    scene.lights.clear();
    for (uint32_t type = 0; type < CND_LIGHT_TYPE_COUNT; ++type) {
        CndLight light = lightTypeInfo(type).lamp;
        light.type = type;
        light.position[1] = 2.5f;
        light.direction[1] = -1;
        std::swap(light.axisV[0], light.axisV[2]); // perpendicular to axisU
        light.emission[type % 3] = 100;
        light.influenceRadius = cndEmitterBoundingRadius(&light) + 4;
        scene.lights.push_back(light);
    }
    expectSameLights(scene, again(scene, {"every_light.json"}));
}

TEST_F(Save, PlanesAndBallsUnderEveryLight)
{
    const Scene scene = loadSceneJson(dataPath("every_light.json"));
    const Scene saved = again(scene, {"every_light.json"});
    expectSameLights(scene, saved);
    expectSameCamera(scene.cameras[0], saved.cameras[0]);
    ASSERT_EQ(saved.analyticObjects.size(), scene.analyticObjects.size());
    for (size_t i = 0; i < scene.analyticObjects.size(); ++i) {
        const AnalyticObject &a = scene.analyticObjects[i], &b = saved.analyticObjects[i];
        EXPECT_EQ(a.type, b.type);
        EXPECT_EQ(a.point, b.point);
        EXPECT_EQ(a.radius, b.radius);
        EXPECT_EQ(a.occluderLayer, b.occluderLayer);
        const Material &m = scene.materials[a.material], &n = saved.materials[b.material];
        EXPECT_EQ(m.baseColor, n.baseColor);
        EXPECT_EQ(m.dielectricF0, n.dielectricF0);
        EXPECT_EQ(m.perceptualRoughness, n.perceptualRoughness);
        EXPECT_EQ(m.diffuseWeight, n.diffuseWeight);
        EXPECT_EQ(m.specularWeight, n.specularWeight);
    }
    EXPECT_EQ(scene.resolution, saved.resolution);
    EXPECT_EQ(scene.background, saved.background);
    EXPECT_EQ(scene.lightsVisible, saved.lightsVisible);
}

TEST_F(Save, ShowcaseIsWrittenOut)
{
    Scene scene = loadScene("showcase", {});
    scene.lights[1].layers = 0b101;
    scene.cameras[0].layers = 0b100;
    expectSameCamera(scene.cameras[0], again(scene, {"showcase"}).cameras[0]);
    expectSameLights(scene, again(scene, {"showcase"}));
    overrideMaterials(scene.materials, {true, 0.3f, 1});
    const Scene metal = again(scene, {"showcase"});
    ASSERT_EQ(metal.analyticObjects.size(), scene.analyticObjects.size());
    for (size_t i = 0; i < scene.analyticObjects.size(); ++i) {
        const Material& m = metal.materials[metal.analyticObjects[i].material];
        EXPECT_EQ(m.baseColor, glm::vec3(0));
        EXPECT_EQ(m.dielectricF0, scene.materials[scene.analyticObjects[i].material].baseColor);
        EXPECT_EQ(m.perceptualRoughness, 0.3f);
    }
}

// Surfaces come from the source, with its seed; lights come from the description.
TEST_F(Save, ScenesOfMeshesReferToTheirSource)
{
    for (const char* name : {"hall", "field", "fence", "rooms"}) {
        Scene scene = loadScene(name, {.lights = 30, .seed = 7});
        scene.lights.erase(scene.lights.begin() + 3);
        scene.lights[5].radius *= 2;
        scene.lights[5].influenceRadius *= 2;
        const Scene saved = again(scene, {name, 7, {true, 0.2f, 0.5f}});
        expectSameLights(scene, saved);
        expectSameCamera(scene.cameras[0], saved.cameras[0]);
        EXPECT_EQ(saved.exposureCompensation, -1);
        ASSERT_EQ(saved.instances.size(), scene.instances.size()) << name;
        for (size_t i = 0; i < scene.instances.size(); ++i)
            EXPECT_EQ(saved.instances[i].worldFromObject, scene.instances[i].worldFromObject);
        ASSERT_EQ(saved.meshes.size(), scene.meshes.size()) << name;
        for (size_t i = 0; i < scene.meshes.size(); ++i)
            EXPECT_EQ(saved.meshes[i].vertices.size(), scene.meshes[i].vertices.size()) << name;
        for (const Material& m : saved.materials) {
            EXPECT_EQ(m.perceptualRoughness, 0.2f);
            EXPECT_EQ(m.metalness, 0.5f);
        }
        EXPECT_EQ(saved.lobes, scene.lobes);
    }
}

// The path is relative, so it stays valid when both files are moved and wherever the program is
// started.
TEST_F(Save, GltfFilesAreReferredToFromTheFolderOfTheDescription)
{
    const WorkingFolder started(folder_.path(""));
    folder_.write("all/models/triangle.gltf", triangleScene().text());
    const Scene scene = loadScene("all/models/triangle.gltf", {.lights = 4});
    const auto sourceIn = [&](const std::string& path) {
        return Json::parse(sceneDescription(scene, sceneSource("all/models/triangle.gltf", 1),
                                            scene.cameras[0], 0, path))["source"]["scene"];
    };
    EXPECT_EQ(sourceIn("candelabra-001.json"), "all/models/triangle.gltf");
    EXPECT_EQ(sourceIn(folder_.path("all/models/saved.json")), "triangle.gltf");
    const std::string deep = "all/scenes/deep/saved.json";
    EXPECT_EQ(sourceIn(deep), "../../models/triangle.gltf");

    folder_.write(deep, sceneDescription(scene, sceneSource("all/models/triangle.gltf", 1),
                                         scene.cameras[0], 0, deep));
    std::filesystem::rename("all", "moved");
    std::filesystem::create_directories("elsewhere");
    const WorkingFolder elsewhere("elsewhere");
    const Scene saved = loadScene("../moved/scenes/deep/saved.json", {});
    EXPECT_EQ(brokenInvariant(saved), "");
    expectSameLights(scene, saved);
    EXPECT_EQ(saved.instances.size(), scene.instances.size());
    EXPECT_TRUE(saved.energyCompensation); // as in the file itself
    EXPECT_EQ(saved.lobes, CND_LOBES_CONSERVING);
}

// A description that was saved, opened and saved again still refers to the file below its
// materials.
TEST_F(Save, DescriptionsThatReferToASceneAreSavedAgain)
{
    folder_.write("models/Triangle.GLB", triangleScene().glb());
    const std::string file = folder_.path("models/Triangle.GLB"),
                      first = folder_.path("first.json"),
                      second = folder_.path("other/second.json");
    const Scene scene = loadScene(file, {.lights = 4});
    SceneSource source = sceneSource(file, 1);
    source.materials = {true, 0.25f, 0.75f};
    folder_.write("first.json", sceneDescription(scene, source, scene.cameras[0], 0, first));
    const Scene opened = loadScene(first, {});
    folder_.write("other/second.json",
                  sceneDescription(opened, sceneSource(first, 1), opened.cameras[0], 0, second));
    const Scene saved = loadScene(second, {});
    expectSameLights(scene, saved);
    ASSERT_EQ(saved.instances.size(), scene.instances.size());
    for (const Material& m : saved.materials) {
        EXPECT_EQ(m.perceptualRoughness, 0.25f);
        EXPECT_EQ(m.metalness, 0.75f);
    }

    // For a generated scene, too, the seed comes from the description.
    const Scene hall = loadScene("hall", {.lights = 3, .seed = 9});
    folder_.write("hall.json", sceneDescription(hall, {"hall", 9}, hall.cameras[0], 0, "x.json"));
    const SceneSource again = sceneSource(folder_.path("hall.json"), 1);
    EXPECT_EQ(again.scene, "hall");
    EXPECT_EQ(again.seed, 9u);
    EXPECT_FALSE(again.materials.on);
}

TEST_F(Save, MovingLightsStandWhereTheyAre)
{
    const Scene scene = loadScene("hall", {.lights = 5, .moving = true});
    const Scene saved = again(scene, {"hall"}, 2.5);
    std::vector<CndLight> lights;
    lightsAtTime(scene, 2.5, lights);
    ASSERT_EQ(saved.lights.size(), lights.size());
    for (size_t i = 0; i < lights.size(); ++i)
        EXPECT_LT(glm::length(worldPositionOf(saved, saved.lights[i]) -
                              worldPositionOf(scene, lights[i])),
                  1e-5);
    EXPECT_TRUE(saved.lightMotions.empty());
}

TEST_F(Save, WhatTheFormatCannotSayIsRefused)
{
    Scene scene = loadScene("showcase", {});
    Camera camera = scene.cameras[0];
    camera.orthographic = true;
    EXPECT_THROW(sceneDescription(scene, {"showcase"}, camera, 0, ""), SceneError);
    scene.materials[0].perceptualRoughness = 0;
    EXPECT_THROW(sceneDescription(scene, {"showcase"}, scene.cameras[0], 0, ""), SceneError);

    const std::string rest = R"(, "lights": [], "camera": {"position": [0, 0, 3],
        "look_at": [0, 0, 0], "up": [0, 1, 0], "vertical_fov_degrees": 40}})";
    const struct {
        std::string source, named;
    } cases[] = {
        {R"({"source": {"scene": "scene.json"})", "source.scene"},
        {R"({"source": {"scene": "village"})", "village"},
        {R"({"source": {"scene": "no_such.glb"})", "no_such.glb"},
        {R"({"source": {"scene": "hall", "lights": 5})", "lights"},
        {R"({"source": {"scene": "hall", "seed": -1})", "source.seed"},
        {R"({"source": {"scene": "hall", "material": {"metalness": 2}})", "perceptual_roughness"},
        {R"({"source": {"scene": "hall"}, "objects": [])", "objects"}};
    for (const auto& [source, named] : cases)
        EXPECT_NE(refusal(source + rest).find(named), std::string::npos)
            << source << ": " << refusal(source + rest);
}

} // namespace candelabra::test
