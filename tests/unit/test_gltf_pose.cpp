// SPDX-License-Identifier: Apache-2.0
// Tests that meshes have the pose of the file: morph targets by their weights, and skins by the
// nodes that are their joints.
#include <cmath>

#include "unit/gltf_fixture.h"

namespace candelabra::test
{

namespace
{

using namespace candelabra::app;

using GltfPoseTest = GltfTest;

void expectNear(const glm::dvec3& actual, const glm::dvec3& expected)
{
    EXPECT_NEAR(glm::distance(actual, expected), 0, 1e-6)
        << actual.x << ", " << actual.y << ", " << actual.z;
}

// The triangle with two morph targets: the first lifts its last corner, the second moves all of it
// along z and turns its normals.
GltfBuilder morphedTriangle()
{
    GltfBuilder b = triangleScene();
    Json& primitive = b.json["meshes"][0]["primitives"][0];
    primitive["targets"] = {{{"POSITION", b.floats({0, 0, 0, 0, 0, 0, 0, 2, 0}, "VEC3")}},
                            {{"POSITION", b.floats({0, 0, 4, 0, 0, 4, 0, 0, 4}, "VEC3")},
                             {"NORMAL", b.floats({2, 0, -2, 2, 0, -2, 2, 0, -2}, "VEC3")}}};
    return b;
}

TEST_F(GltfPoseTest, MorphTargetsWithoutWeightsChangeNothing)
{
    const Scene scene = load(morphedTriangle());
    expectNear(worldPosition(scene, scene.instances.at(0), 2), {0, 1, 0});
    EXPECT_FALSE(warns(scene, "targets"));
}

TEST_F(GltfPoseTest, MorphTargetsAreAddedByTheirWeights)
{
    GltfBuilder b = morphedTriangle();
    b.json["meshes"][0]["weights"] = {1, 0.5};
    const Scene scene = load(b);
    expectNear(worldPosition(scene, scene.instances.at(0), 0), {0, 0, 2});
    expectNear(worldPosition(scene, scene.instances.at(0), 2), {0, 3, 2});
    expectNear(worldNormal(scene, scene.instances.at(0), 0), {1, 0, 0});
}

// The weight of the first target is 0.5, and that of the second 0.
TEST_F(GltfPoseTest, MorphTargetsChangeColoursAndTextureCoordinates)
{
    GltfBuilder b = triangleScene();
    Json& primitive = b.json["meshes"][0]["primitives"][0];
    primitive["attributes"]["COLOR_0"] = b.floats({1, 0, 0, 1, 0, 0, 1, 0, 0}, "VEC3");
    primitive["attributes"]["TEXCOORD_0"] = b.floats({0, 0, 1, 0, 0, 1}, "VEC2");
    primitive["attributes"]["TEXCOORD_1"] = b.floats({5, 5, 5, 5, 5, 5}, "VEC2");
    const std::vector<int8_t> colors = {-127, 127, 0, 0, 0, 0, 0, 0, 0, 0, 127, 0};
    const int colorOffsets =
        b.accessor(b.view(colors, 4), componentByte, "VEC3", 3, {{"normalized", true}});
    const int uvOffsets = b.floats({0.5f, 1, 0, 0, 0, 0}, "VEC2");
    const int far = b.floats({9, 9, 9, 9, 9, 9}, "VEC2");
    primitive["targets"] = {
        {{"COLOR_0", colorOffsets}, {"TEXCOORD_0", uvOffsets}, {"TEXCOORD_1", far}},
        {{"TEXCOORD_0", far}}};
    b.json["meshes"][0]["weights"] = {0.5, 0};
    const Scene scene = load(b);
    const std::vector<Vertex>& v = scene.meshes.at(0).vertices;
    EXPECT_EQ(v[0].color, glm::vec4(0.5f, 0.5f, 0, 1));
    EXPECT_EQ(v[1].color, glm::vec4(1, 0, 0, 1));
    EXPECT_EQ(v[2].color, glm::vec4(1, 0, 0.5f, 1));
    EXPECT_EQ(v[0].uv[0], glm::vec2(0.25f, 0.5f));
    EXPECT_EQ(v[1].uv[0], glm::vec2(1, 0));
    EXPECT_EQ(v[2].uv[1], glm::vec2(9.5f, 9.5f));
    b.json["meshes"][0]["weights"] = {-4, 0}; // colours are clamped
    EXPECT_EQ(load(b).meshes.at(0).vertices[0].color, glm::vec4(1, 0, 0, 1));
    b.json["meshes"][0]["weights"] = {1e12, 0};
    primitive["targets"][0]["TEXCOORD_0"] = b.floats({1e30f, 0, 0, 0, 0, 0}, "VEC2");
    EXPECT_NE(error(b).find("is not finite with its morph targets"), std::string::npos) << error(b);
    primitive["targets"][0]["COLOR_0"] = uvOffsets;
    EXPECT_NE(error(b).find("targets[0].COLOR_0: accessors["), std::string::npos) << error(b);
    primitive["targets"][0]["COLOR_0"] = b.accessor(b.view(colors, 4), componentByte, "VEC3", 3);
    EXPECT_NE(
        error(b).find("targets[0].COLOR_0: accessors[10] has integers that are not normalized"),
        std::string::npos)
        << error(b);
}

// Offsets of colours may have an alpha or not, whether or not the colours have one (glTF 2.0,
// section 3.7.2.2). Offsets without it have the alpha 0, and colours without it have the alpha 1.
TEST_F(GltfPoseTest, MorphTargetsOfColoursMayHaveAlphaOrNot)
{
    GltfBuilder b = triangleScene();
    b.json["materials"] = Json::parse(R"([{"alphaMode": "BLEND"}])");
    Json& primitive = b.json["meshes"][0]["primitives"][0];
    primitive["material"] = 0;
    b.json["meshes"][0]["weights"] = {0.5};
    const int plain = b.floats({1, 0, 0, 1, 0, 0, 1, 0, 0}, "VEC3");
    const int clear = b.floats({1, 0, 0, 0.5f, 1, 0, 0, 0.5f, 1, 0, 0, 0.5f}, "VEC4");
    const int offsets = b.floats({0, 1, 0, 0, 0, 0, -1, 0, 0}, "VEC3");
    const int fading = b.floats({0, 1, 0, -0.5f, 0, 0, 0, 0.5f, -1, 0, 0, 0}, "VEC4");
    const auto colors = [&](int base, int target) {
        primitive["attributes"]["COLOR_0"] = base;
        primitive["targets"] = {{{"COLOR_0", target}}};
        std::vector<glm::vec4> out;
        const Scene scene = load(b);
        for (const Vertex& v : scene.meshes.at(0).vertices)
            out.push_back(v.color);
        return out;
    };
    using Colors = std::vector<glm::vec4>;
    EXPECT_EQ(colors(plain, offsets), (Colors{{1, 0.5f, 0, 1}, {1, 0, 0, 1}, {0.5f, 0, 0, 1}}));
    EXPECT_EQ(colors(clear, offsets),
              (Colors{{1, 0.5f, 0, 0.5f}, {1, 0, 0, 0.5f}, {0.5f, 0, 0, 0.5f}}));
    EXPECT_EQ(colors(plain, fading), (Colors{{1, 0.5f, 0, 0.75f}, {1, 0, 0, 1}, {0.5f, 0, 0, 1}}));
    EXPECT_EQ(colors(clear, fading),
              (Colors{{1, 0.5f, 0, 0.25f}, {1, 0, 0, 0.75f}, {0.5f, 0, 0, 0.5f}}));
    // A target of an attribute that the primitive does not have changes nothing, broken or not.
    primitive["attributes"].erase("COLOR_0");
    primitive["targets"][0]["COLOR_0"] = b.floats({9, 9, 9, 9, 9, 9}, "VEC2");
    EXPECT_EQ(load(b).meshes.at(0).vertices[0].color, glm::vec4(1));
}

TEST_F(GltfPoseTest, WeightsOfANodeReplaceThoseOfItsMesh)
{
    GltfBuilder b = morphedTriangle();
    b.json["meshes"][0]["weights"] = {1, 0};
    b.rootNode({{"mesh", 0}});
    b.rootNode({{"mesh", 0}, {"weights", {0, 1}}});
    const Scene scene = load(b);
    ASSERT_EQ(scene.instances.size(), 3u);
    EXPECT_EQ(scene.instances[0].mesh, scene.instances[1].mesh); // the same pose
    expectNear(worldPosition(scene, scene.instances[1], 2), {0, 3, 0});
    expectNear(worldPosition(scene, scene.instances[2], 2), {0, 1, 4});
}

TEST_F(GltfPoseTest, BrokenMorphTargetsAreNamed)
{
    GltfBuilder b = morphedTriangle();
    Json& primitive = b.json["meshes"][0]["primitives"][0];
    b.json["meshes"][0]["weights"] = {1e13};
    EXPECT_TRUE(warns(load(b), "meshes[0].weights[0]: must be <= 1e+12, is 10000000000000.0; "
                               "weights of 0 are used"));
    b.json["meshes"][0]["weights"] = {1};
    primitive["targets"][0]["POSITION"] = b.floats({0, 0, 0}, "VEC3");
    EXPECT_NE(error(b).find("meshes[0].primitives[0].targets[0].POSITION: accessors["),
              std::string::npos)
        << error(b);
    primitive["targets"][0]["POSITION"] = 99;
    EXPECT_NE(error(b).find("meshes[0].primitives[0].targets[0].POSITION: is 99"),
              std::string::npos)
        << error(b);
}

// The triangle with a skin of two joints. The first corner follows joint 0, the second joint 1, and
// the third both, with weights that add up to 2. Joint 1 is turned by 90 degrees about z, and bound
// at (1, 0, 0).
GltfBuilder skinnedTriangle()
{
    GltfBuilder b = triangleScene();
    Json& attributes = b.json["meshes"][0]["primitives"][0]["attributes"];
    const std::vector<uint8_t> joints = {0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0};
    attributes["JOINTS_0"] = b.accessor(b.view(joints), componentUnsignedByte, "VEC4", 3);
    attributes["WEIGHTS_0"] = b.floats({1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 0, 0}, "VEC4");
    const std::vector<float> inverse = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0,  0, 0, 1,
                                        1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -1, 0, 0, 1};
    const int bind = b.accessor(b.view(inverse), componentFloat, "MAT4", 2);
    const double s = std::sqrt(0.5);
    const int first = b.rootNode({{"translation", {0, 0, 5}}});
    const int second = b.rootNode({{"translation", {0, 0, 7}}, {"rotation", {0, 0, s, s}}});
    b.json["skins"] = {{{"joints", {first, second}}, {"inverseBindMatrices", bind}}};
    b.json["nodes"][0]["skin"] = 0;
    return b;
}

TEST_F(GltfPoseTest, VerticesFollowTheirJoints)
{
    const Scene scene = load(skinnedTriangle());
    ASSERT_EQ(scene.instances.size(), 1u);
    const Instance& instance = scene.instances[0];
    expectNear(worldPosition(scene, instance, 0), {0, 0, 5});
    expectNear(worldPosition(scene, instance, 1), {0, 0, 7});
    // (0, 1, 5) by joint 0; by joint 1 (-1, 1, 0) is turned to (-1, -1, 7).
    expectNear(worldPosition(scene, instance, 2), {-0.5, 0, 6});
    EXPECT_FALSE(warns(scene, "skin"));
}

TEST_F(GltfPoseTest, TheNodeOfASkinnedMeshDoesNotMoveIt)
{
    GltfBuilder b = skinnedTriangle();
    b.json["nodes"][0]["translation"] = {8, 0, 0};
    b.json["nodes"][0]["scale"] = {-3, 2, 1};
    const Scene scene = load(b);
    const Instance& instance = scene.instances.at(0);
    expectNear(worldPosition(scene, instance, 0), {0, 0, 5});
    expectNear(worldPosition(scene, instance, 1), {0, 0, 7});
    expectNear(worldPosition(scene, instance, 2), {-0.5, 0, 6});
}

TEST_F(GltfPoseTest, NormalsTurnWithTheirJoints)
{
    GltfBuilder b = skinnedTriangle();
    const double s = std::sqrt(0.5);
    b.json["nodes"][1]["rotation"] = {0, s, 0, s}; // +z to +x
    b.json["nodes"][1]["scale"] = {1, 4, 9};
    b.json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] =
        b.floats({0, 0.6f, 0.8f, 0, 0, 1, 0, 0, 1}, "VEC3");
    const Scene scene = load(b);
    expectNear(worldNormal(scene, scene.instances.at(0), 0),
               glm::normalize(glm::dvec3(0.8 / 9, 0.6 / 4, 0)));
    expectNear(worldNormal(scene, scene.instances.at(0), 1), {0, 0, 1});
}

TEST_F(GltfPoseTest, JointsNeedNotBeInTheScene)
{
    GltfBuilder b = skinnedTriangle();
    b.json["scenes"][0]["nodes"] = {0};
    const Scene scene = load(b);
    expectNear(worldPosition(scene, scene.instances.at(0), 1), {0, 0, 7});
}

TEST_F(GltfPoseTest, SkinsWithoutInfluencesAreReported)
{
    GltfBuilder b = skinnedTriangle();
    b.json["meshes"][0]["primitives"][0]["attributes"].erase("WEIGHTS_0");
    const Scene scene = load(b);
    EXPECT_TRUE(warns(scene, "meshes[0].primitives[0]: has no JOINTS_0 or no WEIGHTS_0"));
    expectNear(worldPosition(scene, scene.instances.at(0), 1), {1, 0, 0});
}

TEST_F(GltfPoseTest, VerticesWithoutWeightsFollowTheFirstJoint)
{
    GltfBuilder b = skinnedTriangle();
    b.json["meshes"][0]["primitives"][0]["attributes"]["WEIGHTS_0"] =
        b.floats({1, 0, 0, 0, 0, 0, 0, 0, 1, 1, 0, 0}, "VEC4");
    const Scene scene = load(b);
    expectNear(worldPosition(scene, scene.instances.at(0), 1), {1, 0, 5});
    EXPECT_TRUE(warns(scene, "has vertices whose weights are 0"));
}

TEST_F(GltfPoseTest, BrokenSkinsAreNamed)
{
    GltfBuilder few = skinnedTriangle();
    few.json["skins"][0]["joints"] = {1};
    EXPECT_NE(
        error(few).find("meshes[0].primitives[0]: vertex 1 follows joint 1, but skins[0] has 1 "
                        "joint"),
        std::string::npos)
        << error(few);
    GltfBuilder none = skinnedTriangle();
    none.json["skins"][0]["joints"] = Json::array();
    EXPECT_NE(error(none).find("skins[0]: has no joints"), std::string::npos) << error(none);
    GltfBuilder wrong = skinnedTriangle();
    wrong.json["skins"][0]["inverseBindMatrices"] = 0; // positions
    EXPECT_NE(error(wrong).find("skins[0].inverseBindMatrices: accessors[0] must have a MAT4"),
              std::string::npos)
        << error(wrong);
    GltfBuilder types = skinnedTriangle();
    Json& attributes = types.json["meshes"][0]["primitives"][0]["attributes"];
    attributes["JOINTS_0"] = types.floats(std::vector<float>(12), "VEC4");
    EXPECT_NE(error(types).find("must have unsigned bytes or shorts"), std::string::npos)
        << error(types);
    GltfBuilder negative = skinnedTriangle();
    negative.json["meshes"][0]["primitives"][0]["attributes"]["WEIGHTS_0"] =
        negative.floats({1, 0, 0, 0, 1, -1, 0, 0, 1, 1, 0, 0}, "VEC4");
    EXPECT_NE(error(negative).find("vertex 1 has a joint whose weight"), std::string::npos)
        << error(negative);
    GltfBuilder index = skinnedTriangle();
    index.json["skins"][0]["joints"] = {1, 77};
    EXPECT_TRUE(warns(load(index),
                      "skins[0].joints[1]: is 77, but there are 3 nodes; the skin is left out"));
}

} // namespace

} // namespace candelabra::test
