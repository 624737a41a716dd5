// SPDX-License-Identifier: Apache-2.0
// Tests that points and lines of glTF files are drawn, as boxes whose width is a share of the
// scene.
#include <algorithm>
#include <cmath>

#include "gltf/mesh.h"
#include "gltf/wires.h"
#include "unit/gltf_fixture.h"

namespace candelabra::test
{

namespace
{

using namespace candelabra::app;

constexpr const char* onePixel =
    "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAA"
    "DUlEQVR42mNk+M9QDwADhgGAWjR9awAAAABJRU5ErkJggg==";

constexpr const char* tooManyPoints =
    "meshes[0].primitives[0]: brings the scene above 33554432 vertices; points are drawn as boxes, "
    "of which a scene has room for at most 4194304, and each instance has boxes of its own: keep "
    "fewer points in the file, such as every second one";

class GltfWireTest : public GltfTest
{
protected:
    // A scene whose bounds have the diagonal 300 m, so that lines are 1 m wide and single points
    // 2 m: its vertices are (0,0,0), (100,0,0), (100,200,0) and (100,200,200).
    static GltfBuilder wires(int mode, const Json& attributes = Json::object())
    {
        GltfBuilder b;
        Json primitive = {{"mode", mode}, {"attributes", attributes}};
        primitive["attributes"]["POSITION"] =
            b.floats({0, 0, 0, 100, 0, 0, 100, 200, 0, 100, 200, 200}, "VEC3");
        b.rootNode({{"mesh", b.mesh(primitive)}});
        return b;
    }
    static Bounds boxBounds(const Scene& scene, size_t box)
    {
        const Instance& instance = scene.instances.at(0);
        Bounds out{glm::dvec3(1e9), glm::dvec3(-1e9)};
        for (size_t corner = 36 * box; corner < 36 * box + 36; ++corner) {
            const glm::dvec3 p = worldPosition(scene, instance, corner);
            out = {glm::min(out.min, p), glm::max(out.max, p)};
        }
        return out;
    }
    // Returns the message of the SceneError that `act` throws, or "no error".
    template <typename Act>
    static std::string refusal(const GltfDocument& document, Act&& act)
    {
        try {
            act();
        } catch (const SceneError& error) {
            return document.withoutFile(error.what());
        }
        return "no error";
    }
    static size_t boxes(const Scene& scene) { return scene.meshes.at(0).indices.size() / 36; }
    static void expectNear(const glm::dvec3& actual, const glm::dvec3& expected)
    {
        EXPECT_NEAR(glm::distance(actual, expected), 0, 1e-3)
            << actual.x << ", " << actual.y << ", " << actual.z;
    }
};

TEST_F(GltfWireTest, PointsAreCubes)
{
    const Scene scene = load(wires(0));
    ASSERT_EQ(boxes(scene), 4u);
    const Bounds second = boxBounds(scene, 1);
    expectNear(second.min, {99, -1, -1});
    expectNear(second.max, {101, 1, 1});
    ASSERT_EQ(scene.notes.size(), 1u);
    EXPECT_EQ(scene.notes[0],
              "the scene has 4 points, which have no width in the file and are drawn 2 m wide");
}

TEST_F(GltfWireTest, LinesLoopsAndStripsJoinTheirVertices)
{
    const glm::dvec3 corners[] = {{0, 0, 0}, {100, 0, 0}, {100, 200, 0}, {100, 200, 200}};
    const std::vector<std::pair<int, int>> expected[] = {
        {{0, 1}, {2, 3}}, {{0, 1}, {1, 2}, {2, 3}, {3, 0}}, {{0, 1}, {1, 2}, {2, 3}}};
    for (const int mode : {1, 2, 3}) {
        SCOPED_TRACE(mode);
        const Scene scene = load(wires(mode));
        const auto& lines = expected[mode - 1];
        ASSERT_EQ(boxes(scene), lines.size());
        for (size_t i = 0; i < lines.size(); ++i) {
            const Bounds box = boxBounds(scene, i);
            const glm::dvec3 a = corners[lines[i].first], b = corners[lines[i].second];
            expectNear(0.5 * (box.min + box.max), 0.5 * (a + b));
            if (lines[i] != std::pair(3, 0)) // along an axis, and half a metre beyond its ends
                expectNear(box.max - box.min, glm::abs(b - a) + 1.0);
        }
    }
}

// Every side of a box is seen from outside.
TEST_F(GltfWireTest, BoxesAreClosed)
{
    GltfBuilder b = wires(2);
    b.json["nodes"][0]["scale"] = {-1, 1, 1};
    const Scene scene = load(b);
    const Instance& instance = scene.instances.at(0);
    for (size_t box = 0; box < 4; ++box) {
        glm::dvec3 sum{0}, centre{0};
        double area = 0;
        for (size_t corner = 36 * box; corner < 36 * box + 36; ++corner)
            centre += worldPosition(scene, instance, corner) / 36.0;
        for (size_t t = 12 * box; t < 12 * box + 12; ++t) {
            const glm::dvec3 normal = worldAreaNormal(scene, instance, t);
            EXPECT_GT(glm::dot(normal, worldPosition(scene, instance, 3 * t) - centre), 0);
            sum += normal;
            area += glm::length(normal);
        }
        EXPECT_LT(glm::length(sum), 1e-3 * area);
    }
}

// glTF 2.0, section 3.9.7: without normals, points and lines have their colour whatever the light.
TEST_F(GltfWireTest, WithoutNormalsLightChangesNothing)
{
    GltfBuilder b = wires(3);
    b.json["materials"] = Json::parse(R"([{"emissiveFactor": [0, 0.5, 0],
        "pbrMetallicRoughness": {"baseColorFactor": [1, 0, 0.25, 1]}}])");
    b.json["meshes"][0]["primitives"][0]["material"] = 0;
    const Scene unlit = load(b);
    const Material& material = unlit.materials.at(unlit.instances.at(0).material);
    EXPECT_TRUE(material.unlit);
    EXPECT_EQ(material.emission, unlitLuminance * glm::vec3(1, 0.5f, 0.25f));
    EXPECT_FALSE(unlit.materials[0].unlit); // triangles may have it too
    b.json["materials"][0]["emissiveTexture"] = {{"index", 0}};
    b.json["textures"] = Json::parse(R"([{"source": 0}])");
    b.json["images"] = Json::array({{{"uri", onePixel}}});
    const Scene textured = load(b);          // the factor says nothing without the texture
    ASSERT_EQ(textured.textures.size(), 1u); // the image was read
    EXPECT_EQ(textured.materials.at(textured.instances.at(0).material).emission,
              unlitLuminance * glm::vec3(1, 0, 0.25f));
    b.json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] =
        b.floats({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
    b.json["nodes"][0]["rotation"] = {0, std::sqrt(0.5), 0, std::sqrt(0.5)}; // +z to +x
    const Scene lit = load(b);
    EXPECT_FALSE(lit.materials.at(lit.instances.at(0).material).unlit);
    expectNear(worldNormal(lit, lit.instances[0], 0), {1, 0, 0});
}

TEST_F(GltfWireTest, OneZeroNormalMakesLinesUnlitWithAWarning)
{
    GltfBuilder b = wires(3);
    b.json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] =
        b.floats({0, 0, 1, 0, 0, 0, 0, 0, 1, 0, 0, 1}, "VEC3");
    const Scene scene = load(b);
    EXPECT_TRUE(scene.materials.at(scene.instances.at(0).material).unlit);
    EXPECT_TRUE(warns(scene, "meshes[0].primitives[0]: has normals of zero length, so its lines "
                             "are drawn in their plain colours, whatever the light"));
}

// Points and lines have no tangents, along which a normal map lies.
TEST_F(GltfWireTest, NormalMapsAreLeftOut)
{
    GltfBuilder b = wires(3);
    b.json["materials"] = Json::parse(R"([{"normalTexture": {"index": 0}}])");
    b.json["textures"] = Json::parse(R"([{"source": 0}])");
    b.json["images"] = Json::array({{{"uri", onePixel}}});
    Json& primitive = b.json["meshes"][0]["primitives"][0];
    primitive["material"] = 0;
    primitive["attributes"]["NORMAL"] = b.floats({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
    b.json["nodes"].push_back(b.json["nodes"][0]);
    b.json["scenes"][0]["nodes"].push_back(1);
    const Scene scene = load(b);
    ASSERT_EQ(scene.instances.size(), 2u);
    ASSERT_EQ(scene.materials.size(), 2u); // one copy for both
    for (const Instance& instance : scene.instances) {
        EXPECT_FALSE(scene.materials.at(instance.material).unlit);
        EXPECT_EQ(scene.materials.at(instance.material).normalTexture.texture, -1);
    }
    EXPECT_EQ(scene.materials[0].normalTexture.texture, 0); // triangles may have it too
    EXPECT_TRUE(warns(scene, "materials[0]: has a normal map, which points and lines are drawn "
                             "without"));
}

TEST_F(GltfWireTest, UnlitMaterialsAreNotCopied)
{
    GltfBuilder b = wires(3);
    b.json["extensionsUsed"] = {"KHR_materials_unlit"};
    b.json["materials"] = Json::parse(R"([{"extensions": {"KHR_materials_unlit": {}}}])");
    b.json["meshes"][0]["primitives"][0]["material"] = 0;
    const Scene scene = load(b);
    EXPECT_EQ(scene.materials.size(), 1u);
    EXPECT_EQ(scene.instances.at(0).material, 0u);
}

TEST_F(GltfWireTest, ColoursRunAlongLines)
{
    GltfBuilder b = wires(1);
    b.json["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] =
        b.floats({1, 0, 0, 0, 0, 1, 0, 1, 0, 1, 1, 1}, "VEC3");
    const Scene scene = load(b);
    ASSERT_GE(scene.meshes.at(0).vertices.size(), 8u); // the corners of the first line
    for (size_t i = 0; i < 8; ++i) {
        const Vertex& v = scene.meshes[0].vertices[i];
        EXPECT_EQ(v.color, v.position.x < 50 ? glm::vec4(1, 0, 0, 1) : glm::vec4(0, 0, 1, 1));
    }
}

TEST_F(GltfWireTest, ManyPointsAreSmaller)
{
    GltfBuilder b;
    std::vector<float> grid;
    for (int i = 0; i < 100 * 100; ++i)
        grid.insert(grid.end(), {float(i % 100), float(i / 100), 0});
    b.rootNode(
        {{"mesh", b.mesh({{"mode", 0}, {"attributes", {{"POSITION", b.floats(grid, "VEC3")}}}})}});
    const Scene scene = load(b);
    ASSERT_EQ(boxes(scene), 10'000u);
    const Bounds box = boxBounds(scene, 0);
    EXPECT_NEAR(box.max.x - box.min.x, std::sqrt(2.0) * 99 / 150, 1e-3); // 1/150 is the most
    for (int copy = 0; copy < 8; ++copy)
        b.rootNode({{"mesh", 0}});
    const Scene more = load(b);
    ASSERT_EQ(more.instances.size(), 9u);
    const Bounds smaller = boxBounds(more, 0);
    EXPECT_NEAR(smaller.max.x - smaller.min.x, std::sqrt(2.0) * 99 * 1.5 / 300, 1e-3);
}

TEST_F(GltfWireTest, OnePointIsDrawn)
{
    GltfBuilder b;
    b.rootNode({{"translation", {5, 6, 7}},
                {"mesh", b.mesh({{"mode", 0},
                                 {"attributes", {{"POSITION", b.floats({1, 1, 1}, "VEC3")}}}})}});
    const Bounds bounds = sceneBounds(load(b));
    expectNear(0.5 * (bounds.min + bounds.max), {6, 7, 8});
    EXPECT_GT(bounds.max.x, bounds.min.x);
}

TEST_F(GltfWireTest, LinesWithoutALengthAreDropped)
{
    GltfBuilder b = wires(1);
    Json& primitive = b.json["meshes"][0]["primitives"][0];
    primitive["indices"] = b.indices({0, 0, 0, 1, 2});
    const Scene scene = load(b);
    EXPECT_EQ(boxes(scene), 1u);
    EXPECT_TRUE(warns(scene, "is a list of lines with 5 ends"));
    primitive["indices"] = b.indices({0, 0});
    EXPECT_TRUE(warns(load(b), "meshes[0].primitives[0]: has no lines and is left out"));
}

TEST_F(GltfWireTest, LoopsOfOneAndTwoVertices)
{
    GltfBuilder b = wires(2);
    Json& primitive = b.json["meshes"][0]["primitives"][0];
    primitive["indices"] = b.indices({2});
    EXPECT_TRUE(warns(load(b), "meshes[0].primitives[0]: has no lines and is left out"));
    primitive["indices"] = b.indices({0, 1}); // there and back
    const Scene scene = load(b);
    ASSERT_EQ(boxes(scene), 2u);
    for (size_t box = 0; box < 2; ++box) {
        const Bounds bounds = boxBounds(scene, box);
        EXPECT_NEAR(bounds.max.x - bounds.min.x, 100 + 100.0 / 300, 1e-3);
    }
}

TEST_F(GltfWireTest, BrokenAndTooManyPointsAndLinesAreRefused)
{
    GltfBuilder b = wires(1);
    Json& primitive = b.json["meshes"][0]["primitives"][0];
    primitive["indices"] = b.indices({0, 4});
    EXPECT_NE(error(b).find("meshes[0].primitives[0].indices: accessors[1] element 1 is 4, but "
                            "there are 4 vertices"),
              std::string::npos)
        << error(b);
    primitive["mode"] = 0;
    const std::vector<uint8_t> zeros(4'200'000); // the same point again and again
    primitive["indices"] = b.accessor(b.view(zeros), componentUnsignedByte, "SCALAR", zeros.size());
    EXPECT_NE(error(b).find(tooManyPoints), std::string::npos) << error(b);
}

// Each instance of a mesh of one point is a mesh, which costs 64 vertices besides the 8 of its box.
TEST_F(GltfWireTest, TooManyInstancesOfOnePointAreRefused)
{
    const GltfDocument document = openGltf(folder_.write("scene.gltf", wires(0).text()));
    Scene scene;
    scene.materials.emplace_back();
    GltfMeshBudget budget{.vertices = 3 * 72};
    GltfWires points(document, scene, budget);
    const GltfWire point{.vertices = {Vertex{}}, .ends = {0, 0}, .isPoints = true};
    for (int instance = 0; instance < 3; ++instance)
        points.add("meshes[0].primitives[0]", point, glm::dmat4(1), 0);
    EXPECT_EQ(scene.instances.size(), 3u);
    EXPECT_EQ(
        refusal(document, [&] { points.add("meshes[0].primitives[0]", point, glm::dmat4(1), 0); }),
        tooManyPoints);
}

// Points and lines that do not fit as they are read, before they become boxes, are refused with the
// same words.
TEST_F(GltfWireTest, TooManyPointsAndLinesAreRefusedWhenTheyAreRead)
{
    const auto reading = [&](int mode, GltfMeshBudget budget) {
        const GltfDocument document = openGltf(folder_.write("scene.gltf", wires(mode).text()));
        return refusal(document, [&] { readGltfWire(document, 0, 0, GltfPose{}, budget); });
    };
    EXPECT_EQ(reading(0, {.vertices = 4}), "no error");
    EXPECT_EQ(reading(0, {.vertices = 3}), tooManyPoints);
    EXPECT_EQ(
        reading(3, {.vertices = 3}),
        "meshes[0].primitives[0]: brings the scene above 33554432 vertices; lines are drawn as "
        "boxes, of which a scene has room for at most 4194304, and each instance has boxes of its "
        "own: keep fewer lines in the file, such as every second one");
    // A point is read as one index, and then becomes two ends.
    EXPECT_EQ(reading(0, {.indices = 12}), "no error");
    for (const uint64_t indices : {3, 11}) {
        const std::string message = reading(0, {.indices = indices});
        EXPECT_NE(message.find("above 268435456 indices; points are drawn as boxes"),
                  std::string::npos)
            << message;
    }
}

TEST_F(GltfWireTest, InstancesOfOneLine)
{
    GltfBuilder b = wires(1);
    b.json["meshes"][0]["primitives"][0]["indices"] = b.indices({0, 1});
    b.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {
        {"TRANSLATION", b.floats({0, 0, 0, 0, 7, 0}, "VEC3")},
        {"SCALE", b.floats({1, 1, 1, 3, 1, 1}, "VEC3")}};
    const Scene scene = load(b);
    ASSERT_EQ(scene.instances.size(), 2u);
    double width = 0;
    for (size_t i = 0; i < 2; ++i) {
        glm::dvec3 low(1e9), high(-1e9);
        for (size_t corner = 0; corner < 36; ++corner) {
            low = glm::min(low, worldPosition(scene, scene.instances[i], corner));
            high = glm::max(high, worldPosition(scene, scene.instances[i], corner));
        }
        if (i == 0)
            width = high.y - low.y;
        expectNear(0.5 * (low + high), i == 0 ? glm::dvec3(50, 0, 0) : glm::dvec3(150, 7, 0));
        // Its scale makes an instance longer, and not wider.
        expectNear(high - low, glm::dvec3(i == 0 ? 100 : 300, 0, 0) + width);
    }
    ASSERT_EQ(scene.notes.size(), 1u);
    EXPECT_EQ(scene.notes[0],
              "the scene has 2 lines, which have no width in the file and are drawn 1 m wide");
}

// Points and lines stand beside the triangles of their mesh, also where a transform flattens them.
TEST_F(GltfWireTest, TrianglesAndLinesOfAMeshAreDrawn)
{
    GltfBuilder b = triangleScene();
    Json& primitives = b.json["meshes"][0]["primitives"];
    primitives.push_back({{"mode", 2}, {"attributes", primitives[0]["attributes"]}});
    EXPECT_EQ(load(b).instances.size(), 2u);
    b.json["nodes"][0]["scale"] = {1, 1, 0};
    const Scene flat = load(b);
    EXPECT_EQ(flat.instances.size(), 1u);
    EXPECT_TRUE(warns(flat, "flattens its mesh"));
}

} // namespace

} // namespace candelabra::test
