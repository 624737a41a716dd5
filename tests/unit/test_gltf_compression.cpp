// SPDX-License-Identifier: Apache-2.0
// Tests compressed glTF: Draco, meshoptimizer, and what is refused before memory is allocated.
#include <algorithm>
#include <cmath>

#include <meshoptimizer.h>

#include "harness/full_tests.h"
#include "unit/gltf_compressed.h"
#include "unit/gltf_fixture.h"

namespace candelabra::test
{

namespace
{

using namespace candelabra::app;

using GltfCompression = GltfTest;

// The corners of all triangles, as (position, normal, uv), in an order that does not depend on how
// a codec has sorted triangles and vertices. Each triangle begins with its smallest corner.
std::vector<std::array<float, 24>> sortedTriangles(const Mesh& mesh)
{
    std::vector<std::array<float, 24>> out;
    for (size_t t = 0; t < mesh.indices.size(); t += 3) {
        std::array<std::array<float, 8>, 3> corners;
        for (size_t k = 0; k < 3; ++k) {
            const Vertex& v = mesh.vertices[mesh.indices[t + k]];
            corners[k] = {v.position.x, v.position.y, v.position.z, v.normal.x,
                          v.normal.y,   v.normal.z,   v.uv[0].x,    v.uv[0].y};
        }
        std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()),
                    corners.end());
        std::array<float, 24> triangle;
        for (size_t i = 0; i < 24; ++i)
            triangle[i] = corners[i / 8][i % 8];
        out.push_back(triangle);
    }
    std::sort(out.begin(), out.end());
    return out;
}

TEST_F(GltfCompression, EveryCodecGivesTheSameTriangles)
{
    const auto expected = sortedTriangles(load(plainGrid(12)).meshes.at(0));
    ASSERT_EQ(expected.size(), 288u);
    const GltfBuilder compressed[] = {dracoGrid(12, DracoMethod::Sequential),
                                      dracoGrid(12, DracoMethod::Edgebreaker), meshoptGrid(12)};
    for (const GltfBuilder& builder : compressed) {
        SCOPED_TRACE(builder.json["extensionsUsed"].dump());
        const Scene fromText = load(builder);
        EXPECT_EQ(sortedTriangles(fromText.meshes.at(0)), expected);
        EXPECT_EQ(fromText.warnings.size(), 1u); // it has no lights
        const Scene fromBinary = loadScene(folder_.write("scene.glb", builder.glb()), {});
        EXPECT_EQ(sortedTriangles(fromBinary.meshes.at(0)), expected);
    }
}

// A strip in Draco holds a list of triangles like everything else.
TEST_F(GltfCompression, DracoIgnoresTheTopology)
{
    GltfBuilder b = dracoGrid(3, DracoMethod::Edgebreaker);
    b.json["meshes"][0]["primitives"][0]["mode"] = 5;
    EXPECT_EQ(load(b).meshes.at(0).indices.size(), 54u);
}

TEST_F(GltfCompression, MeshoptFiltersAndIndexSequences)
{
    GltfBuilder b;
    b.json["extensionsRequired"] = {"EXT_meshopt_compression", "KHR_mesh_quantization"};
    b.fallbackBuffer = true;
    const std::vector<float> positions = {0, 0, 0, 1000.5f, 0, 0, 0, 0.25f, 0};
    const std::vector<float> normals = {0, 0, 1, 0, 0.6f, 0, 0.8f, 0, -0.8f, 0, 0.6f, 0};
    const auto encoded = [](const void* data, size_t stride) {
        Bytes out(meshopt_encodeVertexBufferBound(3, stride));
        out.resize(meshopt_encodeVertexBuffer(out.data(), out.size(), data, 3, stride));
        return out;
    };
    std::vector<uint32_t> exponential(9);
    meshopt_encodeFilterExp(exponential.data(), 3, 12, 20, positions.data());
    std::vector<int8_t> octahedral(12);
    meshopt_encodeFilterOct(octahedral.data(), 3, 4, 8, normals.data());
    const std::vector<uint32_t> indices = {2, 0, 1};
    Bytes sequence(meshopt_encodeIndexSequenceBound(3, 3));
    sequence.resize(
        meshopt_encodeIndexSequence(sequence.data(), sequence.size(), indices.data(), 3));
    const int position = b.accessor(
        addMeshoptView(b, encoded(exponential.data(), 12), 12, 3, "ATTRIBUTES", "EXPONENTIAL"),
        componentFloat, "VEC3", 3);
    const int normalView =
        addMeshoptView(b, encoded(octahedral.data(), 4), 4, 3, "ATTRIBUTES", "OCTAHEDRAL");
    b.json["bufferViews"][static_cast<size_t>(normalView)]["byteStride"] = 4;
    const int normal = b.accessor(normalView, componentByte, "VEC3", 3, {{"normalized", true}});
    const int index = b.accessor(addMeshoptView(b, sequence, 2, 3, "INDICES"),
                                 componentUnsignedShort, "SCALAR", 3);
    b.rootNode({{"mesh", b.mesh({{"attributes", {{"POSITION", position}, {"NORMAL", normal}}},
                                 {"indices", index}})}});
    const Scene scene = load(b);
    const Mesh& mesh = scene.meshes.at(0);
    ASSERT_EQ(mesh.indices.size(), 3u);
    for (size_t k = 0; k < 3; ++k) {
        const Vertex& v = mesh.vertices[mesh.indices[k]];
        const size_t source = indices[k];
        for (int c = 0; c < 3; ++c) {
            // 20 bits of mantissa, shared by nothing here; 8-bit octahedral coordinates
            const float p = positions[3 * source + static_cast<size_t>(c)];
            EXPECT_NEAR(v.position[c], p, 1e-5f * std::abs(p));
            EXPECT_NEAR(v.normal[c], normals[4 * source + static_cast<size_t>(c)], 0.02);
        }
    }
}

// A file may hold the same data without compression, for programs that do not know the extension.
TEST_F(GltfCompression, FallbacksOfOtherExtensionsAreUsed)
{
    GltfBuilder b = plainGrid(2);
    b.json["extensionsUsed"] = {"EXT_other_compression"};
    for (Json& view : b.json["bufferViews"])
        view["extensions"] = {{"EXT_other_compression", {{"buffer", 77}}}};
    const Scene scene = load(b);
    EXPECT_EQ(scene.meshes.at(0).indices.size(), 24u);
    EXPECT_TRUE(warns(scene, "\"EXT_other_compression\" is not supported"));
}

TEST_F(GltfCompression, MeshoptRefusals)
{
    struct Case {
        const char* pointer;
        Json value;
        const char* message;
    };
    const Case cases[] = {
        // 13 x 13 positions are compressed to about 1.5 kB
        {"/count", 1 << 24, "too many for the"},
        {"/count", 250, "cannot be decompressed"},
        {"/byteStride", 10, "byteStride of ATTRIBUTES must be a multiple of 4"},
        {"/byteStride", 300, "byteStride"},
        {"/byteLength", 1 << 30, "extends beyond buffers[0]"},
        {"/byteOffset", 1 << 30, "extends beyond buffers[0]"},
        {"/byteOffset", 1, "cannot be decompressed"},
        {"/buffer", 1, "extends beyond buffers[1]"},
        {"/buffer", 2, "there are 2 buffers"},
        {"/mode", "ZIP", "must be one of ATTRIBUTES, TRIANGLES, INDICES"},
        {"/mode", "INDICES", "byteStride of INDICES must be 2 or 4"},
        {"/filter", "OCTAHEDRAL", "must be 4 or 8 for the filter"},
        {"/filter", "QUATERNION", "must be 8 for the filter"},
        {"/filter", "SHARP", "filter: must be one of"},
    };
    const GltfBuilder valid = meshoptGrid(12);
    const std::string place = "/bufferViews/1/extensions/EXT_meshopt_compression";
    for (const Case& c : cases) {
        GltfBuilder b = valid;
        b.json[Json::json_pointer(place + c.pointer)] = c.value;
        SCOPED_TRACE(c.pointer + c.value.dump());
        const std::string message = error(b);
        EXPECT_NE(message.find(c.message), std::string::npos) << message;
        EXPECT_NE(message.find("bufferViews[1].extensions"), std::string::npos) << message;
    }
    GltfBuilder triangles = valid;
    triangles.json[Json::json_pointer("/bufferViews/0/extensions/EXT_meshopt_compression/count")] =
        863;
    EXPECT_NE(error(triangles).find("must be a multiple of 3"), std::string::npos);
    GltfBuilder newer = valid;
    const size_t at = newer.json[Json::json_pointer(place + "/byteOffset")];
    ASSERT_EQ(newer.binary[at], 0xa0);
    newer.binary[at] = 0xa1;
    EXPECT_NE(error(newer).find("export with EXT_meshopt_compression"), std::string::npos);
}

TEST_F(GltfCompression, DracoRefusals)
{
    for (const DracoMethod method : {DracoMethod::Sequential, DracoMethod::Edgebreaker}) {
        const GltfBuilder valid = dracoGrid(12, method);
        const auto edited = [&](size_t accessor, size_t count) {
            GltfBuilder b = valid;
            b.json["accessors"][accessor]["count"] = count;
            return error(b);
        };
        // Accessor 0 has the indices, 1 to 3 the attributes in an order of their own.
        size_t positions = valid.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"];
        size_t indices = valid.json["meshes"][0]["primitives"][0]["indices"];
        EXPECT_NE(edited(indices, 861).find("claims 288 triangles; 287 are allowed"),
                  std::string::npos);
        EXPECT_NE(edited(positions, 168).find("claims 169 vertices; 168 are allowed"),
                  std::string::npos);
        // More is allowed: what was decompressed counts.
        EXPECT_EQ(edited(indices, 100000), "no error");
        // Any byte may be wrong: nothing but a message may follow. Some of them are tried.
        const size_t step = sanitized && !fullTests() ? 113 : 29;
        for (size_t at = 0; at < valid.binary.size(); at += step) {
            GltfBuilder b = valid;
            b.binary[at] ^= 0x5a;
            const std::string message = error(b);
            EXPECT_TRUE(message == "no error" || message.find("scene.gltf: ") != std::string::npos)
                << message;
        }
        GltfBuilder older = valid;
        older.binary[5] = 1; // after "DRACO"
        EXPECT_NE(error(older).find("export again without Draco"), std::string::npos);
        GltfBuilder points = valid;
        points.binary[7] = 0;
        EXPECT_NE(error(points).find("cloud of points"), std::string::npos);
        GltfBuilder other = valid;
        other.binary[0] = 'X';
        EXPECT_NE(error(other).find("has no Draco data"), std::string::npos);
        GltfBuilder unknown = valid;
        unknown.json["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"]
                    ["attributes"]["NORMAL"] = 70;
        EXPECT_NE(error(unknown).find("has no attribute 70, which is to be NORMAL"),
                  std::string::npos);
    }
}

// Data of a few bytes that claims to have very many triangles is refused by the number of its
// bytes, even if its accessors agree.
TEST_F(GltfCompression, DracoClaimsAreBoundedByTheirBytes)
{
    GltfBuilder b = dracoGrid(1, DracoMethod::Edgebreaker);
    const Json view = b.json["bufferViews"][0];
    // After the header of 11 bytes comes the kind of traversal, then the numbers of vertices and
    // triangles, a byte each. Longer numbers have 7 bits per byte.
    Bytes data(b.binary.begin(), b.binary.begin() + 13);
    for (const int byte : {0xff, 0xff, 0xff, 0x07})
        data.push_back(static_cast<uint8_t>(byte));
    data.insert(data.end(), b.binary.begin() + 14, b.binary.end());
    b.binary = data;
    b.json["bufferViews"][0]["byteLength"] = data.size();
    for (Json& accessor : b.json["accessors"])
        accessor["count"] = 100000000;
    const std::string message = error(b);
    EXPECT_NE(message.find("triangles; "), std::string::npos) << message;
}

} // namespace

} // namespace candelabra::test
