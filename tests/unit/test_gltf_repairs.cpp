// SPDX-License-Identifier: Apache-2.0
// One wrong value does not lose a glTF file: what is not needed is replaced or left out, with a
// warning that names the element, the value and what is used instead.
#include <cmath>
#include <functional>

#include "unit/broken_scene_cases.h"
#include "unit/gltf_fixture.h"

namespace candelabra::test
{

namespace
{

using namespace candelabra::app;

using GltfRepairs = GltfTest;

// Returns the scene, which must have the same surfaces as the scene without the fault.
void expectSameSurfaces(const Scene& scene, const Scene& sound)
{
    ASSERT_EQ(scene.instances.size(), sound.instances.size());
    for (size_t i = 0; i < scene.instances.size(); ++i) {
        const Mesh& mesh = scene.meshes[scene.instances[i].mesh];
        const Mesh& soundMesh = sound.meshes[sound.instances[i].mesh];
        EXPECT_EQ(scene.instances[i].worldFromObject, sound.instances[i].worldFromObject);
        ASSERT_EQ(mesh.indices, soundMesh.indices);
        for (size_t v = 0; v < mesh.vertices.size(); ++v)
            EXPECT_EQ(mesh.vertices[v].position, soundMesh.vertices[v].position);
    }
    EXPECT_EQ(scene.lights.size(), sound.lights.size());
    EXPECT_EQ(scene.textures.size(), sound.textures.size());
}

// Writes every integer in a document as exporters do that know no integers.
void writeIntegersWithAPoint(Json& value)
{
    if (value.is_number_integer())
        value = value.get<double>();
    else if (value.is_structured())
        for (Json& item : value)
            writeIntegersWithAPoint(item);
}

TEST_F(GltfRepairs, IntegersMayBeWrittenWithAPoint)
{
    GltfBuilder b = completeGltf();
    const Scene sound = load(b);
    writeIntegersWithAPoint(b.json);
    const Scene scene = load(b);
    expectSameSurfaces(scene, sound);
    ASSERT_EQ(scene.warnings.size(), 1u);
    EXPECT_TRUE(warns(scene, ": is an integer that is written as "));
    EXPECT_TRUE(warns(scene, " others)"));
    b = completeGltf();
    b.json["accessors"][0]["componentType"] = 5126.5; // this is no integer
    EXPECT_NE(error(b).find("accessors[0].componentType: must be an integer"), std::string::npos);
}

// Adds a node with a mesh of one triangle, and returns the mesh.
Json& addTriangle(GltfBuilder& b, const std::vector<uint16_t>& corners = {0, 1, 2})
{
    const int positions = b.floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
    const int normals = b.floats({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
    const int mesh = b.mesh({{"attributes", {{"POSITION", positions}, {"NORMAL", normals}}},
                             {"indices", b.indices(corners)}});
    b.rootNode({{"mesh", mesh}});
    return b.json["meshes"].back();
}

// A mesh with one fault is left out, and the others are drawn. A file that has no other mesh is
// refused, and the message names the fault.
TEST_F(GltfRepairs, OneBrokenMeshDoesNotLoseTheOthers)
{
    struct Fault {
        std::function<void(GltfBuilder&, Json& mesh, Json& accessor)> add;
        const char *reason, *instead; // parts of the message
    };
    const auto primitiveOf = [](Json& mesh) -> Json& { return mesh["primitives"][0]; };
    const Fault faults[] = {
        {[&](auto&, Json& mesh, Json&) { primitiveOf(mesh).erase("attributes"); },
         ".primitives[0]: \"attributes\" is missing", "the primitive is left out"},
        {[&](auto&, Json& mesh, Json&) { primitiveOf(mesh)["attributes"]["NORMAL"] = 99; },
         "attributes.NORMAL: is 99, but there are", "the primitive is left out"},
        {[&](auto&, Json& mesh, Json&) { primitiveOf(mesh)["mode"] = 7; },
         ".primitives[0].mode: must be", "the primitive is left out"},
        {[](auto&, Json& mesh, Json&) { mesh["primitives"] = 5; }, ".primitives: must be an array",
         "the mesh is left out"},
        {[](auto&, Json& mesh, Json&) { mesh.erase("primitives"); }, ": \"primitives\" is missing",
         "the mesh is left out"},
        {[](auto&, Json&, Json& accessor) { accessor.erase("type"); }, ": \"type\" is missing",
         "what uses it is left out"},
        {[](auto&, Json&, Json& accessor) { accessor["count"] = 1000; }, "accessors[",
         "the primitive is left out"},
        {[](GltfBuilder& b, Json&, Json& accessor) {
             b.json["bufferViews"][size_t(accessor["bufferView"])]["buffer"] = 5;
         },
         "buffer: is 5, but there are 1 buffers", "what uses it is left out"},
        {[](GltfBuilder& b, Json& mesh, Json&) {
             mesh["primitives"][0]["indices"] = b.indices({0, 1, 7});
         },
         "element 2 is 7, but", "the primitive is left out"},
        {[](GltfBuilder& b, Json&, Json&) {
             b.json["skins"] = {{{"joints", Json::array()}}};
             b.json["nodes"].back()["skin"] = 0;
         },
         "skins[0]: has no joints", "the mesh of the node is left out"},
    };
    for (const Fault& fault : faults)
        for (const bool alone : {false, true}) {
            GltfBuilder b;
            b.json["scene"] = 0;
            if (!alone)
                addTriangle(b);
            Json& mesh = addTriangle(b);
            const size_t positions = primitiveOf(mesh)["attributes"]["POSITION"];
            fault.add(b, mesh, b.json["accessors"][positions]);
            if (alone) {
                EXPECT_NE(error(b).find(fault.reason), std::string::npos) << error(b);
                continue;
            }
            const Scene scene = load(b);
            EXPECT_EQ(scene.instances.size(), 1u) << fault.reason;
            EXPECT_LE(scene.warnings.size(), 2u) << fault.reason; // the file has no lights
            EXPECT_TRUE(warns(scene, fault.reason)) << scene.warnings[0];
            EXPECT_TRUE(warns(scene, fault.instead)) << scene.warnings[0];
        }
}

// Appends an element that nothing uses to an array of a complete file, and loads it.
TEST_F(GltfRepairs, WhatNothingUsesMayBeBroken)
{
    const Scene sound = load(completeGltf());
    const std::pair<const char*, const char*> faults[] = {
        {"accessors", R"({"componentType": 5124, "count": 1, "type": "SCALAR"})"},
        {"accessors", R"({"bufferView": 99, "componentType": 5126, "count": 3, "type": "VEC3"})"},
        {"accessors", R"({"count": 0})"},
        {"accessors", "null"},
        {"bufferViews", R"({"buffer": 7, "byteLength": 4})"},
        {"bufferViews", R"({"buffer": 0, "byteLength": -4})"},
        {"bufferViews", R"({"buffer": 0, "byteLength": 4, "byteStride": 13})"},
        {"images", R"({"uri": 5})"},
        {"images", R"({"bufferView": 99})"},
        {"samplers", R"({"wrapS": "repeat"})"},
        {"textures", R"({"source": 99})"},
        {"materials", R"({"pbrMetallicRoughness": {"baseColorTexture": {"index": 99}}})"},
        {"materials", "[]"},
        {"meshes", "{}"},
        {"meshes", R"({"primitives": [{"attributes": {"POSITION": 99}}]})"},
        {"meshes", R"({"primitives": [{"attributes": {"POSITION": 0}, "mode": 9}]})"},
        {"cameras", R"({"type": "fisheye"})"},
        {"skins", R"({"joints": [99]})"},
        {"nodes", R"({"matrix": [1, 2, 3]})"},
        {"nodes", "5"},
        {"scenes", R"({"nodes": [99]})"},
        {"scenes", "false"},
    };
    for (const auto& [array, element] : faults) {
        SCOPED_TRACE(std::string(array) + " " + element);
        GltfBuilder b = completeGltf();
        const size_t index = b.json[array].size();
        b.json[array].push_back(Json::parse(element));
        const Scene scene = load(b);
        expectSameSurfaces(scene, sound);
        EXPECT_TRUE(warns(scene, ": " + std::string(array) + "[" + std::to_string(index) + "]"));
        EXPECT_LE(scene.warnings.size(), 2u);
    }
    for (const char* extension : {"KHR_lights_punctual", "KHR_lights_area"}) {
        GltfBuilder b = completeGltf();
        Json& lights = b.json["extensions"][extension]["lights"];
        lights.push_back({{"type", "neon"}});
        const Scene scene = load(b);
        expectSameSurfaces(scene, sound);
    }
}

TEST_F(GltfRepairs, BuffersThatNothingUsesNeedNotBeThere)
{
    const Scene sound = load(completeGltf());
    Json document = Json::parse(completeGltf().text());
    for (const char* buffer : {R"({"byteLength": 4})", R"({"byteLength": 4, "uri": "missing.bin"})",
                               R"({"byteLength": 4, "uri": 7})", R"({"uri": "x"})"}) {
        document["buffers"][1] = Json::parse(buffer);
        const Scene scene = loadScene(folder_.write("scene.gltf", document.dump()), {});
        expectSameSurfaces(scene, sound);
        EXPECT_TRUE(warns(scene, "buffers[1]")) << buffer;
        EXPECT_TRUE(warns(scene, "; nothing uses it, so it is left out")) << buffer;
    }
}

TEST_F(GltfRepairs, NullCountsAsMissing)
{
    const Scene sound = load(completeGltf());
    for (const char* place : {"/extensionsUsed",
                              "/extensionsUsed/0",
                              "/scene",
                              "/asset/generator",
                              "/nodes/0/name",
                              "/nodes/1/camera",
                              "/nodes/2/children",
                              "/nodes/1/matrix",
                              "/materials/0/occlusionTexture",
                              "/materials/0/alphaMode",
                              "/skins",
                              "/animations",
                              "/cameras/0/perspective/aspectRatio",
                              "/samplers/0/wrapT",
                              "/scenes/0/name",
                              "/meshes/0/weights",
                              "/meshes/0/primitives/0/mode",
                              "/accessors/1/byteOffset",
                              "/bufferViews/0/byteStride",
                              "/extensions/KHR_lights_punctual/lights/1/range",
                              "/nodes/5/extensions/EXT_mesh_gpu_instancing",
                              "/nodes/1/extensions"}) {
        GltfBuilder b = completeGltf();
        b.json[Json::json_pointer(place)] = nullptr;
        const Scene scene = load(b);
        expectSameSurfaces(scene, sound);
        ASSERT_EQ(scene.warnings.size(), 1u) << place;
        EXPECT_TRUE(warns(scene, "null")) << scene.warnings[0];
    }
}

// JSON has no such numbers, but exporters write them.
TEST_F(GltfRepairs, NumbersThatAreNotFiniteAreReplaced)
{
    for (const char* number : {"NaN", "Infinity", "-Infinity"}) {
        GltfBuilder b = completeGltf();
        b.json["nodes"][0]["name"] = "a \"NaN\" \\"; // this is text
        std::string text = b.text();
        const std::string range = "\"range\":5";
        ASSERT_NE(text.find(range), std::string::npos);
        text.replace(text.find(range) + 8, 1, number);
        const Scene scene = loadScene(folder_.write("scene.gltf", text), {});
        EXPECT_EQ(scene.lights.at(0).influenceRadius, INFINITY);
        EXPECT_TRUE(warns(scene, std::string("lights[0].range: must be a number, is \"") + number +
                                     "\"; the light has no range"));
    }
}

TEST_F(GltfRepairs, MaterialsAreDrawnWithWhatIsLeftOfThem)
{
    GltfBuilder b = triangleScene();
    b.json["meshes"][0]["primitives"][0]["material"] = 0;
    b.json["materials"] = Json::parse(R"([{
        "pbrMetallicRoughness": {"baseColorFactor": [2, 0.5, -1, 1], "metallicFactor": 7,
                                 "roughnessFactor": "rough"},
        "alphaMode": "GLASS", "doubleSided": 1, "alphaCutoff": -1,
        "emissiveTexture": {"index": 4}, "extensions": {"KHR_materials_ior": {"ior": 0.5}}}])");
    const Scene scene = load(b);
    const Material& m = scene.materials.at(scene.instances.at(0).material);
    EXPECT_EQ(m.baseColor, glm::vec3(1, 0.5f, 0));
    EXPECT_EQ(m.metalness, 1);
    EXPECT_EQ(m.perceptualRoughness, 1);
    EXPECT_EQ(m.alphaMode, AlphaMode::Opaque);
    EXPECT_FALSE(m.doubleSided);
    EXPECT_NEAR(m.dielectricF0.x, 0.04, 1e-6);
    EXPECT_TRUE(warns(scene, "materials[0].pbrMetallicRoughness.metallicFactor: must be"));
    EXPECT_TRUE(warns(scene, "is 7; 1 is used"));
    b.json["materials"][0] = 5;
    EXPECT_TRUE(warns(load(b), "materials[0]: must be an object, is 5; the default material is "
                               "used"));
}

TEST_F(GltfRepairs, CamerasKeepWhatIsRight)
{
    const auto loaded = [&](const char* camera) {
        GltfBuilder b = triangleScene();
        b.json["cameras"] = Json::array({Json::parse(camera)});
        b.rootNode({{"camera", 0}, {"translation", {0.2, 0.2, 3}}});
        return load(b);
    };
    Scene s = loaded(R"({"type": "perspective", "perspective":
                         {"yfov": 0.7, "znear": 0, "zfar": -1, "aspectRatio": 0}})");
    EXPECT_EQ(s.cameras.at(0).verticalFov, 0.7);
    EXPECT_EQ(s.cameras[0].nearPlane, 1e-3);
    EXPECT_EQ(s.cameras[0].farPlane, 0);
    EXPECT_EQ(s.warnings.size(), 4u); // with the one that there are no lights
    s = loaded(R"({"type": "perspective", "perspective": {"yfov": 0.7, "znear": 5, "zfar": 2}})");
    EXPECT_EQ(s.cameras.at(0).farPlane, 0);
    EXPECT_TRUE(warns(s, "cameras[0]: zfar must be greater than znear"));
    s = loaded(R"({"type": "orthographic", "orthographic": {"xmag": -4, "ymag": 2}})");
    EXPECT_TRUE(s.cameras.at(0).orthographic);
    EXPECT_EQ(s.cameras[0].orthographicHeight, 4);
    for (const char* broken :
         {R"({"type": "perspective", "perspective": {"yfov": 0, "znear": 1}})",
          R"({"type": "perspective", "perspective": {"yfov": 4, "znear": 1}})",
          R"({"type": "orthographic", "orthographic": {"xmag": 0, "ymag": 1, "zfar": 9}})",
          R"({"type": "orthographic"})", R"({"type": "fisheye"})"}) {
        s = loaded(broken);
        EXPECT_FALSE(s.cameras.at(0).orthographic) << broken;
        EXPECT_EQ(s.cameras.at(0).name, "three-quarter") << broken; // an automatic one
        EXPECT_TRUE(warns(s, "the camera is left out")) << broken;
    }
}

// The depth of an orthographic camera is linear: whatever far plane a file has, the range that is
// drawn is that of the scene.
TEST_F(GltfRepairs, FarPlanesOfOrthographicCamerasComeToTheScene)
{
    for (const double zfar : {20.0, 1e6, 1e7, 1e12}) {
        GltfBuilder b = triangleScene();
        b.json["cameras"] = Json::parse(R"([{"type": "orthographic", "orthographic":
                                             {"xmag": 2, "ymag": 2, "znear": 0.01}}])");
        b.json["cameras"][0]["orthographic"]["zfar"] = zfar;
        b.rootNode({{"camera", 0}, {"translation", {0, 0, 8}}});
        const Scene s = load(b);
        EXPECT_EQ(s.cameras.at(0).nearPlane, load(b).cameras.at(0).nearPlane);
        EXPECT_GE(s.cameras[0].nearPlane, 0.01);
        EXPECT_LT(s.cameras[0].nearPlane, 8); // the triangle is at 8 m
        EXPECT_GT(s.cameras[0].farPlane, 8);
        EXPECT_LT(s.cameras[0].farPlane, 20);
    }
}

} // namespace

} // namespace candelabra::test
