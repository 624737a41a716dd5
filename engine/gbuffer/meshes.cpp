// SPDX-License-Identifier: Apache-2.0
#include "gbuffer/meshes.h"

#include <algorithm>
#include <cstddef>
#include <string>

#include <meshoptimizer.h>

#include "gbuffer/levels.h"

namespace candelabra::gbuffer
{
namespace
{

// Share of vertex cache efficiency that may be lost to reduce overdraw (meshoptimizer's advice).
constexpr float overdrawThreshold = 1.05f;

void validate(const Mesh& mesh, size_t index)
{
    const std::string name = "mesh " + std::to_string(index);
    if (mesh.indices.size() % 3)
        gpu::failArgument(name + ": the number of indices (" + std::to_string(mesh.indices.size()) +
                          ") is no multiple of 3");
    for (const uint32_t i : mesh.indices)
        if (i >= mesh.vertices.size())
            gpu::failArgument(name + ": index " + std::to_string(i) +
                              " is not below the number of "
                              "vertices, " +
                              std::to_string(mesh.vertices.size()));
}

struct Optimized {
    std::vector<Vertex> vertices;
    std::vector<uint32_t> indices;
};

bool isColored(const Vertex& v)
{
    return std::any_of(std::begin(v.color), std::end(v.color), [](float c) { return c != 1; });
}

Optimized optimize(const Mesh& mesh, Attributes attributes)
{
    const size_t indexCount = mesh.indices.size();
    std::vector<uint32_t> remap(mesh.vertices.size());
    // The members that are drawn are the first ones of a vertex.
    static_assert(offsetof(Vertex, position) == 0 &&
                  offsetof(Vertex, tangent) == sizeof(VertexCore));
    const meshopt_Stream drawn{mesh.vertices.data(),
                               attributes == Attributes::All ? sizeof(Vertex) : sizeof(VertexCore),
                               sizeof(Vertex)};
    const size_t vertexCount = meshopt_generateVertexRemapMulti(
        remap.data(), mesh.indices.data(), indexCount, mesh.vertices.size(), &drawn, 1);
    Optimized o;
    o.vertices.resize(vertexCount);
    o.indices.resize(indexCount);
    meshopt_remapIndexBuffer(o.indices.data(), mesh.indices.data(), indexCount, remap.data());
    meshopt_remapVertexBuffer(o.vertices.data(), mesh.vertices.data(), mesh.vertices.size(),
                              sizeof(Vertex), remap.data());

    std::vector<uint32_t> ordered(indexCount);
    meshopt_optimizeVertexCache(ordered.data(), o.indices.data(), indexCount, vertexCount);
    meshopt_optimizeOverdraw(o.indices.data(), ordered.data(), indexCount,
                             o.vertices.data()->position, vertexCount, sizeof(Vertex),
                             overdrawThreshold);
    std::vector<Vertex> fetched(vertexCount);
    const size_t used = meshopt_optimizeVertexFetch(fetched.data(), o.indices.data(), indexCount,
                                                    o.vertices.data(), vertexCount, sizeof(Vertex));
    fetched.resize(used);
    o.vertices = std::move(fetched);
    return o;
}

void append(PackedMeshes& all, const Optimized& o, Attributes attributes)
{
    PackedMesh mesh{.vertexOffset = uint32_t(all.core.size())};
    const auto addLevel = [&](const std::vector<uint32_t>& indices, float error) {
        mesh.levels.push_back({uint32_t(all.indices.size()), uint32_t(indices.size()), error});
        all.indices.insert(all.indices.end(), indices.begin(), indices.end());
    };
    addLevel(o.indices, 0);
    for (const Level& level : coarserLevels(o.vertices, o.indices, attributes))
        addLevel(level.indices, level.error);
    std::copy_n(o.vertices.front().position, 3, mesh.min);
    std::copy_n(o.vertices.front().position, 3, mesh.max);
    for (const Vertex& v : o.vertices) {
        const auto& p = v.position;
        const auto& n = v.normal;
        const auto& t = v.tangent;
        const auto& c = v.color;
        all.core.push_back({{p[0], p[1], p[2]}, {n[0], n[1], n[2]}});
        all.detail.push_back({{t[0], t[1], t[2], t[3]},
                              {v.uv0[0], v.uv0[1], v.uv1[0], v.uv1[1]},
                              {c[0], c[1], c[2], c[3]}});
        mesh.colored |= isColored(v);
        for (int i = 0; i < 3; ++i) {
            mesh.min[i] = std::min(mesh.min[i], p[i]);
            mesh.max[i] = std::max(mesh.max[i], p[i]);
        }
    }
    all.meshes.push_back(std::move(mesh));
}

} // namespace

PackedMeshes packMeshes(std::span<const Mesh> meshes, const std::vector<bool>& textured)
{
    PackedMeshes all;
    size_t vertices = 0, indices = 0;
    for (size_t i = 0; i < meshes.size(); ++i) {
        validate(meshes[i], i);
        vertices += meshes[i].vertices.size();
        indices += meshes[i].indices.size();
    }
    if (vertices > INT32_MAX || indices > UINT32_MAX)
        gpu::failUnsupported(
            "the meshes together have more vertices or indices than 32-bit indices can address");
    all.core.reserve(vertices);
    all.detail.reserve(vertices);
    all.indices.reserve(indices);
    for (size_t i = 0; i < meshes.size(); ++i) {
        const Mesh& mesh = meshes[i];
        const bool detailed =
            textured[i] || std::any_of(mesh.vertices.begin(), mesh.vertices.end(), isColored);
        const Attributes attributes = detailed ? Attributes::All : Attributes::Normals;
        if (mesh.indices.empty())
            all.meshes.push_back({});
        else
            append(all, optimize(mesh, attributes), attributes);
    }
    // The coarser levels add at most as many indices for each of them.
    if (all.indices.size() > UINT32_MAX)
        gpu::failUnsupported(
            "the meshes and their levels of detail together have more indices than 32-bit indices "
            "can address");
    return all;
}

} // namespace candelabra::gbuffer
