// SPDX-License-Identifier: Apache-2.0
// Groups instances into draws, on three levels:
//
//   run     one multi-draw call: same mesh variant, cull mode, winding and texture set
//    batch  one indirect draw for each level of detail: also the same mesh; at most
//           maxBatchInstances
//     chunk up to 64 instances: handled by one lane of the culling kernels
#pragma once

#include <cstdint>
#include <vector>

#include "gbuffer/geometry.h"
#include "gbuffer/mesh_variant.h"
#include "gbuffer/meshes.h"
#include "gbuffer/triangle_pieces.h"
#include "shared/raster.h"

namespace candelabra::gbuffer
{

// Limit of compact_instances, whose lanes each sum the counts of at most 256 chunks.
constexpr uint32_t maxBatchInstances = 256 * gpu::CHUNK_SIZE;

using TextureSet = std::array<int32_t, gpu::TEXTURES_PER_MATERIAL>; // texture indices by TEXTURE_*;
                                                                    // -1: no texture

struct Run {
    MeshVariant variant;
    bool doubleSided;
    bool mirrored; // the transforms mirror the mesh, which reverses its winding
    uint32_t textureSet;
    uint32_t firstCommand, commandCount;
    bool tested; // cull_triangles tests its triangles, in these pieces
    uint32_t firstPiece, pieceCount;
};

struct Batches {
    std::vector<TextureSet> textureSets; // [0] has no textures
    std::vector<Run> runs;               // those of emissive variants come last
    // For each batch one command per level of its mesh. instanceCount is 0: the GPU writes it.
    std::vector<gpu::DrawCommand> commands;
    uint32_t visibleCount = 0; // room for drawn instances of all commands
    std::vector<gpu::Chunk> chunks;
    std::vector<gpu::InstanceRecord> instances; // sorted by batch
    std::vector<gpu::InstanceBounds> bounds;    // one per instance
    TrianglePieces pieces;
};

// Sorts instances into batches. Batches are sorted by state, then by mesh; within a batch instances
// keep their order. A run has at most `maxDraws` commands. `corners`: room for the corners of
// meshes that cull_triangles tests; with 0 it tests none. Throws gpu::Failure naming an instance,
// or a material, that refers to something that does not exist.
Batches buildBatches(const GeometryDesc& desc, const std::vector<PackedMesh>& meshes,
                     uint32_t maxDraws, uint32_t corners);

// Returns for each mesh whether an instance of it has textures or a coverage.
std::vector<bool> texturedMeshes(const GeometryDesc& desc);

gpu::MaterialRecord materialRecord(const Material& material);

} // namespace candelabra::gbuffer
