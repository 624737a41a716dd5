// SPDX-License-Identifier: Apache-2.0
// Packs all meshes into one vertex and one index buffer.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "gbuffer/geometry.h"

namespace candelabra::gbuffer
{

// The vertex data that every draw reads (core), and that only textured or vertex-coloured draws
// read (detail).
struct VertexCore {
    float position[3], normal[3];
};
struct VertexDetail {
    float tangent[4], uv[4], color[4];
};

struct PackedLevel {
    uint32_t firstIndex, indexCount;
    float error; // in object space; see levels.h
};

struct PackedMesh {
    std::vector<PackedLevel> levels; // [0] is the mesh itself; empty: a mesh without triangles
    uint32_t vertexOffset = 0;
    bool colored = false;     // some vertex colour differs from 1
    float min[3]{}, max[3]{}; // bounding box of the used vertices
};

struct PackedMeshes {
    std::vector<VertexCore> core;
    std::vector<VertexDetail> detail; // one per core
    std::vector<uint32_t> indices;
    std::vector<PackedMesh> meshes;
};

// Merges equal vertices, reorders triangles and vertices for the vertex cache, little overdraw and
// fetch locality (meshoptimizer), and makes coarser levels. Vertices of meshes that are not
// `textured` and have no vertex colours are equal if position and normal are. Throws gpu::Failure
// naming the mesh whose indices are out of range.
PackedMeshes packMeshes(std::span<const Mesh> meshes, const std::vector<bool>& textured);

} // namespace candelabra::gbuffer
