// SPDX-License-Identifier: Apache-2.0
#include "unit/gltf_compressed.h"

#include <cmath>
#include <stdexcept>

#include <draco/compression/encode.h>
#include <draco/mesh/mesh.h>
#include <meshoptimizer.h>
#include <webp/encode.h>

namespace candelabra::test
{

namespace
{

constexpr const char* meshopt = "EXT_meshopt_compression";

int addDracoAttribute(draco::Mesh& mesh, draco::GeometryAttribute::Type type,
                      const std::vector<float>& values, int8_t components)
{
    draco::GeometryAttribute attribute;
    attribute.Init(type, nullptr, components, draco::DT_FLOAT32, false,
                   static_cast<int64_t>(sizeof(float)) * components, 0);
    const int id = mesh.AddAttribute(attribute, true, mesh.num_points());
    for (uint32_t i = 0; i < mesh.num_points(); ++i)
        mesh.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(i),
                                              &values[size_t{i} * static_cast<size_t>(components)]);
    return id;
}

Bytes encodedVertices(const void* vertices, size_t count, size_t stride)
{
    Bytes out(meshopt_encodeVertexBufferBound(count, stride));
    out.resize(meshopt_encodeVertexBuffer(out.data(), out.size(), vertices, count, stride));
    return out;
}

} // namespace

GridData wavyGrid(uint32_t n)
{
    GridData grid;
    for (uint32_t y = 0; y <= n; ++y)
        for (uint32_t x = 0; x <= n; ++x) {
            const float u = static_cast<float>(x) / static_cast<float>(n);
            const float v = static_cast<float>(y) / static_cast<float>(n);
            grid.positions.insert(grid.positions.end(), {u, v, 0.125f * std::sin(7 * u + 3 * v)});
            grid.normals.insert(grid.normals.end(), {0, 0, 1});
            grid.uvs.insert(grid.uvs.end(), {u, 1 - v});
        }
    for (uint32_t y = 0; y < n; ++y)
        for (uint32_t x = 0; x < n; ++x) {
            const uint32_t a = y * (n + 1) + x, b = a + 1, c = a + n + 1, d = c + 1;
            grid.indices.insert(grid.indices.end(), {a, b, c, c, b, d});
        }
    return grid;
}

GltfBuilder plainGrid(uint32_t n)
{
    const GridData grid = wavyGrid(n);
    GltfBuilder b;
    const int indices =
        b.accessor(b.view(grid.indices), componentUnsignedInt, "SCALAR", grid.indices.size());
    b.rootNode({{"mesh", b.mesh({{"attributes",
                                  {{"POSITION", b.floats(grid.positions, "VEC3")},
                                   {"NORMAL", b.floats(grid.normals, "VEC3")},
                                   {"TEXCOORD_0", b.floats(grid.uvs, "VEC2")}}},
                                 {"indices", indices}})}});
    return b;
}

GltfBuilder dracoGrid(uint32_t n, DracoMethod method)
{
    const GridData grid = wavyGrid(n);
    const size_t vertices = grid.positions.size() / 3;
    draco::Mesh mesh;
    mesh.set_num_points(static_cast<uint32_t>(vertices));
    const int position =
        addDracoAttribute(mesh, draco::GeometryAttribute::POSITION, grid.positions, 3);
    const int normal = addDracoAttribute(mesh, draco::GeometryAttribute::NORMAL, grid.normals, 3);
    const int uv = addDracoAttribute(mesh, draco::GeometryAttribute::TEX_COORD, grid.uvs, 2);
    for (size_t i = 0; i < grid.indices.size(); i += 3)
        mesh.AddFace({draco::PointIndex(grid.indices[i]), draco::PointIndex(grid.indices[i + 1]),
                      draco::PointIndex(grid.indices[i + 2])});
    draco::Encoder encoder;
    encoder.SetEncodingMethod(method == DracoMethod::Sequential ? draco::MESH_SEQUENTIAL_ENCODING
                                                                : draco::MESH_EDGEBREAKER_ENCODING);
    draco::EncoderBuffer buffer;
    if (!encoder.EncodeMeshToBuffer(mesh, &buffer).ok())
        throw std::runtime_error("Draco cannot encode the grid");

    GltfBuilder b;
    b.json["extensionsRequired"] = b.json["extensionsUsed"] = {"KHR_draco_mesh_compression"};
    const Bytes bytes(buffer.data(), buffer.data() + buffer.size());
    const Json extension = {{"bufferView", b.view(bytes)},
                            {"attributes",
                             {{"POSITION", mesh.attribute(position)->unique_id()},
                              {"NORMAL", mesh.attribute(normal)->unique_id()},
                              {"TEXCOORD_0", mesh.attribute(uv)->unique_id()}}}};
    const auto declared = [&](const char* type) {
        return b.accessor(-1, componentFloat, type, vertices);
    };
    const int indices = b.accessor(-1, componentUnsignedInt, "SCALAR", grid.indices.size());
    b.rootNode({{"mesh", b.mesh({{"attributes",
                                  {{"POSITION", declared("VEC3")},
                                   {"NORMAL", declared("VEC3")},
                                   {"TEXCOORD_0", declared("VEC2")}}},
                                 {"indices", indices},
                                 {"extensions", {{"KHR_draco_mesh_compression", extension}}}})}});
    return b;
}

int addMeshoptView(GltfBuilder& b, const Bytes& compressed, size_t stride, size_t count,
                   const char* mode, const char* filter)
{
    const int source = b.view(compressed);
    const Json place = b.json["bufferViews"][static_cast<size_t>(source)];
    // The view's own place is in a buffer without data, the second one.
    b.json["bufferViews"][static_cast<size_t>(source)] = {{"buffer", 1},
                                                          {"byteLength", stride * count},
                                                          {"extensions",
                                                           {{meshopt,
                                                             {{"buffer", 0},
                                                              {"byteOffset", place["byteOffset"]},
                                                              {"byteLength", place["byteLength"]},
                                                              {"byteStride", stride},
                                                              {"count", count},
                                                              {"mode", mode},
                                                              {"filter", filter}}}}}};
    return source;
}

GltfBuilder meshoptGrid(uint32_t n)
{
    const GridData grid = wavyGrid(n);
    const size_t vertices = grid.positions.size() / 3;
    GltfBuilder b;
    b.json["extensionsRequired"] = b.json["extensionsUsed"] = {meshopt};
    b.fallbackBuffer = true;
    const auto floats = [&](const std::vector<float>& values, const char* type, size_t components) {
        const size_t stride = components * sizeof(float);
        const Bytes bytes = encodedVertices(values.data(), vertices, stride);
        return b.accessor(addMeshoptView(b, bytes, stride, vertices, "ATTRIBUTES"), componentFloat,
                          type, vertices);
    };
    Bytes indices(meshopt_encodeIndexBufferBound(grid.indices.size(), vertices));
    indices.resize(meshopt_encodeIndexBuffer(indices.data(), indices.size(), grid.indices.data(),
                                             grid.indices.size()));
    const int view = addMeshoptView(b, indices, 4, grid.indices.size(), "TRIANGLES");
    b.rootNode({{"mesh", b.mesh({{"attributes",
                                  {{"POSITION", floats(grid.positions, "VEC3", 3)},
                                   {"NORMAL", floats(grid.normals, "VEC3", 3)},
                                   {"TEXCOORD_0", floats(grid.uvs, "VEC2", 2)}}},
                                 {"indices", b.accessor(view, componentUnsignedInt, "SCALAR",
                                                        grid.indices.size())}})}});
    return b;
}

Bytes smallWebP()
{
    const uint8_t rgba[] = {10, 20, 30, 128, 255, 255, 255, 255};
    uint8_t* encoded = nullptr;
    const size_t size = WebPEncodeLosslessRGBA(rgba, 2, 1, 8, &encoded);
    Bytes out(encoded, encoded + size);
    WebPFree(encoded);
    return out;
}

} // namespace candelabra::test
