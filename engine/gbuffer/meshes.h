// SPDX-License-Identifier: Apache-2.0
// All meshes in one vertex and one index buffer.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "gbuffer/geometry.h"

namespace candelabra::gbuffer
{

// What every draw reads, and what only textured or vertex-coloured draws read.
struct VertexCore {
    float position[3], normal[3];
};
struct VertexDetail {
    float tangent[4], uv[4], color[4];
};

struct PackedMesh {
    uint32_t firstIndex = 0, indexCount = 0;
    uint32_t vertexOffset = 0;
    bool colored = false;     // some vertex colour is not 1
    float min[3]{}, max[3]{}; // bounds of the used vertices
};

struct PackedMeshes {
    std::vector<VertexCore> core;
    std::vector<VertexDetail> detail; // as many as core
    std::vector<uint32_t> indices;
    std::vector<PackedMesh> meshes;
};

// Merges equal vertices and reorders triangles and vertices for the vertex cache, overdraw and
// fetch locality (meshoptimizer). Throws gpu::Failure naming the mesh whose indices are out of
// range.
PackedMeshes packMeshes(std::span<const Mesh> meshes);

} // namespace candelabra::gbuffer
