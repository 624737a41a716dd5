// SPDX-License-Identifier: Apache-2.0
// Tests glTF containers, nodes, scenes and cameras.
#include <cmath>

#include "harness/full_tests.h"
#include "load/load.h"
#include "unit/gltf_fixture.h"

namespace candelabra::test
{

namespace
{

using namespace candelabra::app;

using Gltf = GltfTest;

TEST_F(Gltf, TextAndBinaryGiveTheSameMesh)
{
    const GltfBuilder builder = triangleScene();
    const Scene fromText = load(builder);
    const Scene fromBinary = loadScene(folder_.write("scene.glb", builder.glb()), {});
    const Scene byContent = loadScene(folder_.write("scene.bytes", builder.glb()), {});
    for (const Scene* scene : {&fromText, &fromBinary, &byContent}) {
        EXPECT_EQ(brokenInvariant(*scene), "");
        ASSERT_EQ(scene->instances.size(), 1u);
        const Mesh& mesh = scene->meshes.at(0);
        ASSERT_EQ(mesh.vertices.size(), 3u);
        EXPECT_EQ(mesh.indices, (std::vector<uint32_t>{0, 1, 2}));
        EXPECT_EQ(mesh.vertices[1].position, glm::vec3(1, 0, 0));
        EXPECT_EQ(mesh.vertices[1].normal, glm::vec3(0, 0, 1));
    }
    EXPECT_TRUE(warns(fromText, "has no lights"));
    EXPECT_EQ(fromText.materials.at(0).metalness, 1); // glTF's default material
}

// Files of version 1 may hold their version as a number.
TEST_F(Gltf, OlderVersionsAreRefusedWithWhatConvertsThem)
{
    for (const Json& version : {Json("1.0"), Json("1.1"), Json(1.0), Json(1)}) {
        GltfBuilder builder = triangleScene();
        builder.json["asset"]["version"] = version;
        EXPECT_NE(error(builder).find("gltf-pipeline converts the file"), std::string::npos)
            << version;
    }
    GltfBuilder builder = triangleScene();
    builder.json["asset"]["version"] = 2.0; // must be a text
    EXPECT_TRUE(warns(load(builder), "asset.version: is a number, not text; \"2.0\" is used"));
}

TEST_F(Gltf, BuffersInFilesMayBeLargerThanDeclared)
{
    GltfBuilder builder = triangleScene();
    Bytes data = builder.binary;
    const size_t declared = data.size();
    data.push_back(7);
    folder_.write("sub dir/data.bin", data);
    Json json = builder.json;
    json["buffers"] = {{{"byteLength", declared}, {"uri", "sub%20dir/data.bin"}}};
    const Scene scene = loadScene(folder_.write("scene.gltf", json.dump()), {});
    EXPECT_EQ(scene.meshes.at(0).vertices.size(), 3u);
}

TEST_F(Gltf, HierarchiesMultiplyInDouble)
{
    GltfBuilder builder = triangleScene();
    // The sum 1e7 + 1/64 needs more digits than a float has.
    builder.json["nodes"][0]["translation"] = {0, 0, 0.015625};
    builder.json["nodes"].push_back(
        {{"children", {0}}, {"translation", {0, 0, 1e7}}, {"scale", {2, 2, 1}}});
    builder.json["nodes"].push_back(
        {{"children", {1}}, {"matrix", {0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 5, 6, 7, 1}}});
    builder.json["scenes"][0]["nodes"] = {2};
    const Scene scene = load(builder);
    ASSERT_EQ(scene.instances.size(), 1u);
    // corner (1, 0, 0) -> (2, 0, 1e7 + 1/64) -> rotated by 90 degrees about z, then moved
    EXPECT_EQ(worldPosition(scene, scene.instances[0], 1), glm::dvec3(5, 8, 1e7 + 7 + 0.015625));
}

TEST_F(Gltf, RotationsAreNormalised)
{
    GltfBuilder builder = triangleScene();
    builder.json["nodes"][0]["rotation"] = {0, 0, 0.6, 0.6}; // 90 degrees about z
    const Scene scene = load(builder);
    const glm::dvec3 p = worldPosition(scene, scene.instances[0], 1);
    EXPECT_NEAR(glm::distance(p, glm::dvec3(0, 1, 0)), 0, 1e-15);
}

TEST_F(Gltf, MirroredNodesKeepFrontFacesAndTangentFrames)
{
    GltfBuilder builder = triangleScene();
    const int uv = builder.floats({0, 1, 1, 1, 0, 0}, "VEC2");
    const int tangents = builder.floats({1, 0, 0, -1, 1, 0, 0, -1, 1, 0, 0, -1}, "VEC4");
    builder.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = uv;
    builder.json["meshes"][0]["primitives"][0]["attributes"]["TANGENT"] = tangents;
    builder.rootNode({{"mesh", 0}, {"scale", {-2, 3, 1}}, {"rotation", {0.5, 0.5, 0.5, 0.5}}});
    builder.rootNode({{"mesh", 0}, {"scale", {1, -1, 1}}});
    const Scene scene = load(builder);
    ASSERT_EQ(scene.instances.size(), 3u);
    EXPECT_EQ(scene.meshes.size(), 2u); // one mirrored copy serves both
    for (const Instance& instance : scene.instances) {
        EXPECT_GT(glm::determinant(glm::dmat3(instance.worldFromObject)), 0);
        const glm::dvec3 face = glm::normalize(worldAreaNormal(scene, instance, 0));
        EXPECT_NEAR(glm::distance(face, worldNormal(scene, instance, 0)), 0, 1e-6);
    }
    // (x, y, z) -> (-2x, 3y, z) -> (z, -2x, 3y): corners, normal, tangent and bitangent computed by
    // hand.
    const Instance& turned = scene.instances[1];
    EXPECT_NEAR(glm::distance(worldNormal(scene, turned, 0), glm::dvec3(1, 0, 0)), 0, 1e-6);
    const Vertex& v = scene.meshes[turned.mesh].vertices[0];
    const glm::dmat3 m(turned.worldFromObject);
    const glm::vec3 bitangent = glm::cross(v.normal, glm::vec3(v.tangent)) * v.tangent.w;
    EXPECT_NEAR(glm::distance(m * glm::dvec3(v.tangent), glm::dvec3(0, -2, 0)), 0, 1e-6);
    EXPECT_NEAR(glm::distance(m * glm::dvec3(bitangent), glm::dvec3(0, 0, -3)), 0, 1e-6);
}

TEST_F(Gltf, NodesWithTwoParentsAreNamedWithAHint)
{
    GltfBuilder b = triangleScene();
    b.json["nodes"] = Json::parse(R"([{"name": "left", "children": [2]},
                                      {"children": [2]}, {"name": "wheel", "mesh": 0}])");
    b.json["scenes"][0]["nodes"] = {0, 1};
    EXPECT_NE(error(b).find("nodes[2]: has two parents, nodes[0] \"left\" and nodes[1], but glTF "
                            "allows one: give each of them a copy of nodes[2] \"wheel\" and export "
                            "again"),
              std::string::npos)
        << error(b);
}

// Nodes that files list where they should not are drawn once, where their parents put them.
TEST_F(Gltf, NodesAreDrawnOnceHoweverOftenTheyAreListed)
{
    GltfBuilder b = triangleScene();
    b.json["nodes"] = Json::parse(R"([{"children": [1, 1], "translation": [5, 0, 0]},
                                      {"mesh": 0, "children": [2]}, {"mesh": 0}])");
    for (const Json& roots : {Json{0, 1}, Json{1, 0}, Json{0, 2, 2, 1, 0}}) {
        b.json["scenes"][0]["nodes"] = roots;
        const Scene s = load(b);
        ASSERT_EQ(s.instances.size(), 2u) << roots;
        EXPECT_EQ(s.instances[0].worldFromObject[3].x, 5);
        EXPECT_TRUE(warns(s, "nodes[0].children[1]: is 1, which is listed before; it is left out"));
        EXPECT_TRUE(warns(s, "is listed as a root of scenes[0] and is below another node of it; it "
                             "is drawn once, there"));
    }
    // The parent is in no scene, but it has the transform.
    b.json["scenes"][0]["nodes"] = {1};
    const Scene s = load(b);
    ASSERT_EQ(s.instances.size(), 2u);
    EXPECT_EQ(s.instances[1].worldFromObject[3].x, 5);
    EXPECT_TRUE(warns(s, "nodes[1]: is listed as a root of scenes[0] and is a child of nodes[0]"));
}

// Rough white metal, which is glTF's default material, is white only with the light that bounces
// between its microfacets.
TEST_F(Gltf, EnergyCompensationIsOnByDefault)
{
    EXPECT_TRUE(load(triangleScene()).energyCompensation);
    EXPECT_FALSE(load(triangleScene(), {.energyCompensation = false}).energyCompensation);
    EXPECT_FALSE(loadScene("fence", {}).energyCompensation);
    EXPECT_TRUE(loadScene("fence", {.energyCompensation = true}).energyCompensation);
}

TEST_F(Gltf, FlattenedMeshesAreLeftOut)
{
    GltfBuilder builder = triangleScene();
    builder.json["nodes"][0]["scale"] = {1, 0, 1};
    const Scene scene = load(builder);
    EXPECT_TRUE(scene.instances.empty());
    EXPECT_TRUE(warns(scene, "nodes[0]"));
}

TEST_F(Gltf, WhatIsLeftOutIsReported)
{
    GltfBuilder b = triangleScene();
    b.mesh({{"attributes", Json::object()}});
    b.rootNode({{"mesh", 1}});
    b.json["animations"] = Json::array({Json::object()});
    b.json["extensionsUsed"] = {"EXT_nothing", "KHR_lights_punctual"};
    const Scene scene = load(b);
    EXPECT_EQ(scene.instances.size(), 1u);
    for (const char* text : {"meshes[1].primitives[0]: has no POSITION", "animations",
                             "\"EXT_nothing\" is not supported: what it adds is left out"})
        EXPECT_TRUE(warns(scene, text)) << text;
    EXPECT_FALSE(warns(scene, "KHR_lights_punctual"));
}

// Files that need an extension are drawn without it, as far as that is possible.
TEST_F(Gltf, MissingExtensionsAreNamedWithAHint)
{
    GltfBuilder b = triangleScene();
    b.json["extensionsUsed"] = b.json["extensionsRequired"] = {"KHR_texture_basisu"};
    b.json["extensionsRequired"].push_back("EXT_nothing");
    const Scene scene = load(b);
    EXPECT_EQ(scene.instances.size(), 1u);
    EXPECT_EQ(scene.warnings.size(), 3u); // and it has no lights
    EXPECT_TRUE(warns(scene, "\"KHR_texture_basisu\" is not supported: KTX2 textures are left out; "
                             "export with PNG"));
    b.json["nodes"][0].erase("mesh");
    EXPECT_NE(error(b).find("has nothing that can be drawn without the extensions that it requires "
                            "and that are not supported: \"EXT_nothing\", "
                            "\"KHR_texture_basisu\""),
              std::string::npos)
        << error(b);
}

TEST_F(Gltf, ExtensionsThatAreReadInPartAreNotCalledMissing)
{
    GltfBuilder b = triangleScene();
    b.json["extensionsUsed"] = {"KHR_materials_transmission", "KHR_materials_volume"};
    b.json["extensionsRequired"] = b.json["extensionsUsed"];
    const Scene scene = load(b);
    EXPECT_TRUE(warns(scene, "\"KHR_materials_transmission\" is read in part: by its factor"));
    EXPECT_TRUE(warns(scene, "\"KHR_materials_volume\" is read in part: glass with a thickness is "
                             "drawn opaque"));
    EXPECT_FALSE(warns(scene, "is not supported"));
    b.json["nodes"][0].erase("mesh");
    EXPECT_EQ(error(b), "no error"); // what is missing is not an extension
}

TEST_F(Gltf, WarningsOfTheSameReasonAreOneSentence)
{
    GltfBuilder b = triangleScene();
    for (int i = 1; i < 6; ++i) {
        b.mesh({{"attributes", Json::object()}});
        b.rootNode({{"mesh", i}});
    }
    const Scene scene = load(b);
    EXPECT_EQ(scene.warnings.size(), 2u);
    EXPECT_TRUE(warns(scene, "meshes[1].primitives[0] (and 4 others): has no POSITION"));
}

TEST_F(Gltf, InstancesOfOneMesh)
{
    GltfBuilder b = triangleScene();
    const int translations = b.floats({0, 0, 1, 0, 5, 0}, "VEC3");
    // A quarter turn about z, as normalised bytes, and none at all.
    const int rotations = b.accessor(b.view(std::vector<int8_t>{0, 0, 90, 90, 0, 0, 0, 127}),
                                     componentByte, "VEC4", 2, {{"normalized", true}});
    const int scales = b.floats({2, 2, 2, -1, 1, 1}, "VEC3");
    b.json["nodes"][0]["translation"] = {10, 0, 0};
    b.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {
        {"TRANSLATION", translations},
        {"ROTATION", rotations},
        {"SCALE", scales},
        {"_COLOR", translations}};
    const Scene scene = load(b);
    ASSERT_EQ(scene.instances.size(), 2u);
    // Corner (1, 0, 0) -> (2, 0, 0) -> (0, 2, 0) -> (0, 2, 1) -> (10, 2, 1)
    EXPECT_NEAR(glm::distance(worldPosition(scene, scene.instances[0], 1), {10, 2, 1}), 0, 1e-12);
    // The second one is mirrored, and still shows its front to +z.
    const glm::dvec3 face = worldAreaNormal(scene, scene.instances[1], 0);
    EXPECT_NEAR(glm::distance(glm::normalize(face), {0, 0, 1}), 0, 1e-12);
    EXPECT_NEAR(glm::distance(worldNormal(scene, scene.instances[1], 0), {0, 0, 1}), 0, 1e-6);
    Json& attributes = b.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"];
    attributes["SCALE"] = b.floats({1, 1, 1}, "VEC3");
    EXPECT_NE(error(b).find("SCALE: accessors[6] has 1 elements, others have 2"), std::string::npos)
        << error(b);
    attributes["SCALE"] = rotations;
    EXPECT_NE(error(b).find("wrong number of components"), std::string::npos);
    attributes = Json::object();
    EXPECT_EQ(load(b).instances.size(), 1u);
    attributes["SCALE"] = b.accessor(-1, componentFloat, "VEC3", 1 << 23);
    EXPECT_NE(error(b).find("has 8388608 instances, more than the"), std::string::npos);
    attributes["SCALE"] = b.floats({1e30f, 1, 1}, "VEC3");
    EXPECT_NE(error(b).find("nodes[0]: has a transform that exceeds 1e12 m"), std::string::npos);
}

TEST_F(Gltf, TheDefaultSceneIsUsed)
{
    GltfBuilder b = triangleScene();
    b.json["nodes"].push_back({{"mesh", 0}, {"translation", {7, 0, 0}}});
    b.json["scenes"].push_back({{"nodes", {1}}});
    b.json["scene"] = 1;
    const Scene second = load(b);
    ASSERT_EQ(second.instances.size(), 1u);
    EXPECT_EQ(second.instances[0].worldFromObject[3].x, 7);
    EXPECT_TRUE(warns(second, "has 2 scenes, of which only scenes[1] is drawn"));
    b.json.erase("scene");
    EXPECT_EQ(load(b).instances.at(0).worldFromObject[3].x, 0);
    b.json.erase("scenes");
    const Scene all = load(b);
    EXPECT_EQ(all.instances.size(), 2u);
    EXPECT_TRUE(warns(all, "no scene"));
}

TEST_F(Gltf, DeepHierarchiesDoNotRecurse)
{
    GltfBuilder b = triangleScene();
    constexpr int depth = sanitized ? 20'000 : 100'000; // more calls than a stack has room for
    b.json["scenes"][0]["nodes"] = {1};
    for (int i = 1; i <= depth; ++i)
        b.json["nodes"].push_back(
            {{"children", {i < depth ? i + 1 : 0}}, {"translation", {0, 0, 1}}});
    EXPECT_EQ(load(b).instances.at(0).worldFromObject[3].z, depth);
}

TEST_F(Gltf, CamerasFollowTheirNodes)
{
    GltfBuilder b = triangleScene();
    b.json["cameras"] = Json::parse(R"([
        {"type": "perspective", "name": "wide", "perspective": {"yfov": 1.2, "znear": 0.25}},
        {"type": "perspective",
         "perspective": {"yfov": 0.5, "znear": 0.1, "zfar": 50, "aspectRatio": 2}},
        {"type": "orthographic",
         "orthographic": {"xmag": 6, "ymag": 3, "znear": 0, "zfar": 20}}])");
    // Turned by 90 degrees about y, so it looks along -x; scale must not matter.
    const double s = std::sqrt(0.5);
    b.rootNode({{"camera", 0},
                {"rotation", {0, s, 0, s}},
                {"translation", {1, 2, 3}},
                {"scale", {2, 5, 3}}});
    b.rootNode({{"camera", 1}, {"name", "far"}});
    b.rootNode({{"camera", 2}});
    const Scene scene = load(b);
    ASSERT_GT(scene.cameras.size(), 3u); // then come automatic ones
    const Camera& wide = scene.cameras[0];
    EXPECT_EQ(wide.name, "wide");
    EXPECT_EQ(wide.position, glm::dvec3(1, 2, 3));
    EXPECT_NEAR(glm::distance(wide.forward, glm::dvec3(-1, 0, 0)), 0, 1e-15);
    EXPECT_NEAR(glm::distance(wide.up, glm::dvec3(0, 1, 0)), 0, 1e-15);
    EXPECT_EQ(wide.verticalFov, 1.2);
    EXPECT_EQ(wide.nearPlane, 0.25);
    EXPECT_EQ(wide.farPlane, 0);
    EXPECT_FALSE(wide.aspect);
    EXPECT_EQ(scene.cameras[1].name, "far");
    EXPECT_EQ(scene.cameras[1].farPlane, 50);
    EXPECT_EQ(scene.cameras[1].aspect, 2);
    EXPECT_TRUE(scene.cameras[2].orthographic);
    EXPECT_EQ(scene.cameras[2].orthographicHeight, 6);
    EXPECT_EQ(scene.cameras[2].aspect, 2);
    EXPECT_LE(scene.cameras[2].farPlane, 20); // fitDepthRanges() of load/load.cpp
}

} // namespace

} // namespace candelabra::test
