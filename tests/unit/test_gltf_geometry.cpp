// SPDX-License-Identifier: Apache-2.0
// Tests glTF accessors, topologies, vertex colours, and missing or broken normals and tangents.
#include <cmath>

#include "unit/gltf_fixture.h"

namespace candelabra::test
{

namespace
{

using namespace candelabra::app;

using GltfGeometry = GltfTest;

TEST_F(GltfGeometry, QuantisedStridedAttributes)
{
    GltfBuilder b;
    b.json["extensionsRequired"] = {"KHR_mesh_quantization"};
    const std::vector<int16_t> positions = {0, 0, 0, 99, 32767, 0, 0, 99, -32768, 16384, 0, 99};
    const std::vector<int8_t> normals = {0, 0, 127, 99, 0, 0, 127, 99, 0, 0, 127, 99};
    const std::vector<uint8_t> uvs = {0, 255, 9, 9, 51, 0, 9, 9, 255, 102, 9, 9};
    const std::vector<uint16_t> uvs1 = {3, 4, 0, 65535, 5, 6};
    const Json attributes = {
        {"POSITION",
         b.accessor(b.view(positions, 8), componentShort, "VEC3", 3, {{"normalized", true}})},
        {"NORMAL",
         b.accessor(b.view(normals, 4), componentByte, "VEC3", 3, {{"normalized", true}})},
        {"TEXCOORD_0",
         b.accessor(b.view(uvs, 4), componentUnsignedByte, "VEC2", 3, {{"normalized", true}})},
        {"TEXCOORD_1", b.accessor(b.view(uvs1), componentUnsignedShort, "VEC2", 3)}};
    b.rootNode({{"mesh", b.mesh({{"attributes", attributes}})}});
    const auto v = load(b).meshes.at(0).vertices;
    EXPECT_EQ(v[1].position, glm::vec3(1, 0, 0));
    EXPECT_EQ(v[2].position, glm::vec3(-1, 16384 / 32767.0f, 0)); // -32768 is clamped
    EXPECT_EQ(v[0].normal, glm::vec3(0, 0, 1));
    EXPECT_EQ(v[1].uv[0], glm::vec2(0.2f, 0));
    EXPECT_EQ(v[2].uv[0], glm::vec2(1, 0.4f));
    EXPECT_EQ(v[1].uv[1], glm::vec2(0, 65535)); // not normalised
}

TEST_F(GltfGeometry, SparseAccessorsReplaceElements)
{
    GltfBuilder b = triangleScene();
    const int indices = b.view(std::vector<uint16_t>{0, 2});
    const int values = b.view(std::vector<float>{-1, -1, 0, 0, 5, 0});
    b.json["accessors"][0]["sparse"] = {
        {"count", 2},
        {"indices", {{"bufferView", indices}, {"componentType", componentUnsignedShort}}},
        {"values", {{"bufferView", values}}}};
    const auto onTop = load(b).meshes.at(0).vertices;
    EXPECT_EQ(onTop[0].position, glm::vec3(-1, -1, 0));
    EXPECT_EQ(onTop[1].position, glm::vec3(1, 0, 0));
    EXPECT_EQ(onTop[2].position, glm::vec3(0, 5, 0));
    b.json["accessors"][0].erase("bufferView"); // without a buffer view the base values are zeros
    const auto overZeros = load(b).meshes.at(0).vertices;
    EXPECT_EQ(overZeros[0].position, glm::vec3(-1, -1, 0));
    EXPECT_EQ(overZeros[1].position, glm::vec3(0, 0, 0));
}

// A unit square of four corners in the plane z = 0, drawn in every way that glTF offers.
TEST_F(GltfGeometry, TopologiesAndIndexTypesGiveTheSameSquare)
{
    const std::vector<float> corners = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0};
    for (const int type : {componentUnsignedByte, componentUnsignedShort, componentUnsignedInt, 0})
        for (const int mode : {4, 5, 6}) {
            SCOPED_TRACE("component type " + std::to_string(type) + ", mode " +
                         std::to_string(mode));
            const std::vector<uint32_t> order = mode == 4 ? std::vector<uint32_t>{0, 1, 2, 2, 1, 3}
                                                : mode == 5 ? std::vector<uint32_t>{0, 1, 2, 3}
                                                            : std::vector<uint32_t>{0, 1, 3, 2};
            GltfBuilder b;
            Json primitive = {{"mode", mode}};
            std::vector<float> positions = corners;
            if (type == 0) {
                positions.clear();
                for (const uint32_t i : order)
                    positions.insert(positions.end(), &corners[3 * i], &corners[3 * i] + 3);
            } else if (type == componentUnsignedByte) {
                const int view = b.view(std::vector<uint8_t>(order.begin(), order.end()));
                primitive["indices"] = b.accessor(view, type, "SCALAR", order.size());
            } else if (type == componentUnsignedShort) {
                primitive["indices"] = b.indices({order.begin(), order.end()});
            } else {
                primitive["indices"] = b.accessor(b.view(order), type, "SCALAR", order.size());
            }
            primitive["attributes"] = {{"POSITION", b.floats(positions, "VEC3")}};
            b.rootNode({{"mesh", b.mesh(primitive)}});
            const Scene scene = load(b);
            const Mesh& mesh = scene.meshes.at(0);
            ASSERT_EQ(mesh.indices.size(), 6u);
            const Instance& square = scene.instances.at(0);
            // each triangle is half of the square
            EXPECT_EQ(worldAreaNormal(scene, square, 0), glm::dvec3(0, 0, 1));
            EXPECT_EQ(worldAreaNormal(scene, square, 1), glm::dvec3(0, 0, 1));
            glm::dvec3 sum{0};
            for (size_t corner = 0; corner < 6; ++corner)
                sum += worldPosition(scene, square, corner);
            EXPECT_EQ(sum, glm::dvec3(3, 3, 0)); // together they cover the square
        }
}

TEST_F(GltfGeometry, CornersOfAnIncompleteTriangleAreLeftOutWithAWarning)
{
    GltfBuilder b = triangleScene();
    b.json["meshes"][0]["primitives"][0]["indices"] = b.indices({0, 1, 2, 0, 1});
    const Scene scene = load(b);
    EXPECT_EQ(scene.meshes.at(0).indices.size(), 3u);
    EXPECT_TRUE(warns(scene, "is a triangle list of 5 corners"));
}

TEST_F(GltfGeometry, StitchedStripsLoseTheirDegenerateTriangles)
{
    GltfBuilder b;
    const int positions = b.floats({0, 0, 0, 1, 0, 0, 0, 1, 0, 5, 0, 0, 6, 0, 0, 5, 1, 0}, "VEC3");
    const int indices = b.indices({0, 1, 2, 2, 3, 3, 4, 5});
    b.rootNode(
        {{"mesh",
          b.mesh({{"attributes", {{"POSITION", positions}}}, {"indices", indices}, {"mode", 5}})}});
    const Scene scene = load(b);
    ASSERT_EQ(scene.meshes.at(0).indices.size(), 6u);
    for (size_t t = 0; t < 2; ++t)
        EXPECT_EQ(std::abs(worldAreaNormal(scene, scene.instances[0], t).z), 1);
}

TEST_F(GltfGeometry, OnlyUsedVerticesAreKept)
{
    GltfBuilder b;
    std::vector<float> positions(3 * 1000, 0.0f);
    for (size_t i = 0; i < 1000; ++i)
        positions[3 * i + i % 3] = static_cast<float>(i);
    const int accessor = b.floats(positions, "VEC3");
    const int normals = b.floats(std::vector<float>(3 * 1000, 1.0f), "VEC3");
    b.rootNode({{"mesh", b.mesh({{"attributes", {{"POSITION", accessor}, {"NORMAL", normals}}},
                                 {"indices", b.indices({900, 500, 502, 900, 502, 501})}})}});
    const Scene scene = load(b);
    const Mesh& mesh = scene.meshes.at(0);
    ASSERT_EQ(mesh.vertices.size(), 4u);
    const float expected[] = {900, 500, 502, 900, 502, 501};
    for (size_t i = 0; i < 6; ++i)
        EXPECT_EQ(glm::length(mesh.vertices[mesh.indices[i]].position), expected[i]);
}

TEST_F(GltfGeometry, MissingNormalsAreFlat)
{
    GltfBuilder b;
    const int positions = b.floats({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}, "VEC3");
    b.rootNode({{"mesh", b.mesh({{"attributes", {{"POSITION", positions}}},
                                 {"indices", b.indices({0, 1, 2, 0, 2, 3})}})}});
    const Mesh mesh = load(b).meshes.at(0);
    ASSERT_EQ(mesh.vertices.size(), 6u); // corners are not shared
    for (size_t corner = 0; corner < 6; ++corner)
        EXPECT_EQ(mesh.vertices[mesh.indices[corner]].normal,
                  corner < 3 ? glm::vec3(0, 0, 1) : glm::vec3(1, 0, 0));
}

TEST_F(GltfGeometry, BrokenNormalsAndTangentsAreReplacedAndReported)
{
    GltfBuilder b = triangleScene();
    const int normals = b.floats({0, 0, 0, 0, 0, 9, 0, 0, 1e-9f}, "VEC3");
    const int tangents = b.floats({0, 0, 2, 1, 0, 0, 0, 1, 3, 0, 4, -1}, "VEC4");
    b.json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] = normals;
    b.json["meshes"][0]["primitives"][0]["attributes"]["TANGENT"] = tangents;
    const Scene scene = load(b);
    for (const Vertex& v : scene.meshes.at(0).vertices)
        EXPECT_EQ(v.normal, glm::vec3(0, 0, 1));
    // made perpendicular to the normal
    EXPECT_EQ(scene.meshes[0].vertices[2].tangent, glm::vec4(1, 0, 0, -1));
    EXPECT_TRUE(warns(scene, "2 normals have zero length"));
    EXPECT_TRUE(warns(scene, "2 tangents have no usable direction"));
}

TEST_F(GltfGeometry, VertexColoursOfEveryType)
{
    struct Case {
        int componentType;
        const char* type;
        Bytes data;
    };
    const float floats[] = {0.2f, 0.4f, 0.6f, 0.2f, 0.4f, 0.6f, 0.2f, 0.4f, 0.6f};
    Bytes floatBytes(sizeof floats);
    std::memcpy(floatBytes.data(), floats, sizeof floats);
    const uint16_t shorts[] = {13107, 26214, 39321, 52428, 13107, 26214,
                               39321, 52428, 13107, 26214, 39321, 52428};
    Bytes shortBytes(sizeof shorts);
    std::memcpy(shortBytes.data(), shorts, sizeof shorts);
    for (const Case& c : {Case{componentFloat, "VEC3", floatBytes},
                          Case{componentUnsignedShort, "VEC4", shortBytes},
                          Case{componentUnsignedByte,
                               "VEC4",
                               {51, 102, 153, 204, 51, 102, 153, 204, 51, 102, 153, 204}}}) {
        GltfBuilder b = triangleScene();
        const Json extra = {{"normalized", c.componentType != componentFloat}};
        b.json["materials"] = Json::parse(R"([{"alphaMode": "BLEND"}])");
        b.json["meshes"][0]["primitives"][0]["material"] = 0;
        b.json["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] =
            b.accessor(b.view(c.data), c.componentType, c.type, 3, extra);
        const glm::vec4 color = load(b).meshes.at(0).vertices[2].color;
        EXPECT_FLOAT_EQ(color.x, 0.2f);
        EXPECT_FLOAT_EQ(color.y, 0.4f);
        EXPECT_FLOAT_EQ(color.z, 0.6f);
        EXPECT_FLOAT_EQ(color.w, c.type == std::string("VEC3") ? 1 : 0.8f);
    }
}

TEST_F(GltfGeometry, VertexColoursOutsideTheRangeAreClamped)
{
    GltfBuilder b = triangleScene();
    b.json["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] =
        b.floats({0.5f, 1.5f, -0.5f, 0.5f, 1.00001f, 0.5f, 0.25f, 0.5f, 0.75f}, "VEC3");
    const Scene scene = load(b);
    EXPECT_EQ(scene.meshes.at(0).vertices[0].color, glm::vec4(0.5f, 1, 0, 1));
    EXPECT_EQ(scene.meshes[0].vertices[1].color, glm::vec4(0.5f, 1, 0.5f, 1));
    EXPECT_TRUE(warns(scene, "1 vertex colours are not between 0 and 1 and are clamped"));
}

TEST_F(GltfGeometry, PointsAndLinesAreLeftOutAndCounted)
{
    GltfBuilder b = triangleScene();
    Json& primitives = b.json["meshes"][0]["primitives"];
    const Json triangle = primitives[0];
    for (const int mode : {0, 1, 2, 3}) // 3 points; 1, 3 and 2 lines
        primitives.push_back({{"mode", mode}, {"attributes", triangle["attributes"]}});
    const Scene scene = load(b);
    EXPECT_EQ(scene.instances.size(), 1u);
    EXPECT_TRUE(warns(scene, "has 3 points and 6 lines, which are not drawn"));
    primitives = Json::array({triangle, {{"mode", 1}, {"attributes", triangle["attributes"]}}});
    EXPECT_TRUE(warns(load(b), "has 1 line, which is not drawn"));
    primitives.erase(0);
    EXPECT_NE(error(b).find("scene.gltf: has only points and lines, which are not drawn"),
              std::string::npos)
        << error(b);
}

} // namespace

} // namespace candelabra::test
