// SPDX-License-Identifier: Apache-2.0
// Groups instances into draws.
//
//   run     pipeline variant, cull mode, winding and texture set: one multi-draw call
//    batch  and one mesh: one indirect draw; at most maxBatchInstances
//     chunk up to 64 instances: one lane of the culling kernels
#pragma once

#include <cstdint>
#include <vector>

#include "gbuffer/geometry.h"
#include "gbuffer/meshes.h"
#include "shared/raster.h"

namespace candelabra::gbuffer
{

// compact_instances sums the counts of up to maxBatchInstances / CHUNK_SIZE = 256 chunks per lane.
constexpr uint32_t maxBatchInstances = 256 * gpu::CHUNK_SIZE;

enum class Variant : uint32_t { Plain, Detailed, Masked, Count };

using TextureSet = std::array<int32_t, gpu::TEXTURES_PER_MATERIAL>; // by TEXTURE_*, -1: none

struct Run {
    Variant variant;
    bool doubleSided;
    bool mirrored; // the transforms turn the winding round
    uint32_t textureSet;
    uint32_t firstCommand, commandCount;
};

struct Batches {
    std::vector<TextureSet> textureSets; // [0] has no textures
    std::vector<Run> runs;
    std::vector<gpu::DrawCommand> commands; // instanceCount is 0: the GPU fills it in
    std::vector<gpu::Chunk> chunks;
    std::vector<gpu::InstanceRecord> instances; // batch after batch
    std::vector<gpu::InstanceBounds> bounds;    // as many
};

// Keeps the order of instances within a batch; batches are sorted by state, then by mesh. At most
// `maxDraws` commands per run. Throws gpu::Failure naming an instance, or material, that refers to
// something that does not exist.
Batches buildBatches(const GeometryDesc& desc, const std::vector<PackedMesh>& meshes,
                     uint32_t maxDraws);

gpu::MaterialRecord materialRecord(const Material& material);

} // namespace candelabra::gbuffer
