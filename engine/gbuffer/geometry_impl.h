// SPDX-License-Identifier: Apache-2.0
// The GPU objects that a Geometry owns and GBuffer uses.
#pragma once

#include <vector>

#include "gbuffer/batches.h"
#include "gbuffer/geometry.h"
#include "gpu/kernel.h"
#include "gpu/memory.h"

namespace candelabra::gbuffer
{

// Descriptor set 0 of the mesh shaders: the union of the bindings of both stages.
std::vector<gpu::ReflectedBinding> meshBindings();

// The buffers that cull_triangles reads and writes. Without pieces it is not run, and the buffers
// are empty.
struct TriangleTest {
    uint32_t pieceCount = 0;
    gpu::Buffer corners; // texel buffer
    gpu::Buffer batches, batchOfPiece, kept, draws;
    gpu::Buffer frame; // gpu::CullTrianglesFrame of the latest frame
    gpu::Bindings set;
};

struct Geometry::Impl {
    // Part of the staging buffer that is copied to a buffer.
    struct Copy {
        VkBuffer target;
        VkBufferCopy region;
    };
    // Part of the staging buffer that is copied to all mip levels of a texture.
    struct TextureCopy {
        uint32_t texture;
        VkDeviceSize offset;
    };

    const gpu::Device* device;
    GeometryCounts counts;

    // All VertexCore, followed from detailOffset on by all VertexDetail.
    gpu::Buffer vertices, indices;
    VkDeviceSize detailOffset = 0;
    gpu::Buffer instances, materials; // texel buffers
    gpu::Buffer bounds, chunks, bits, chunkCounts, visible, commands;
    gpu::Buffer cullFrame; // gpu::CullInstancesFrame of the latest frame
    uint32_t chunkCount = 0;
    TriangleTest triangles;

    std::vector<gpu::Image> textures; // those of the description, followed by a white texel
    std::vector<gpu::Handle<VkSampler>> samplers;
    gpu::Bindings meshSets; // one set per texture set
    gpu::Bindings cullSet, compactSet;

    std::vector<Run> runs;
    std::vector<AnalyticObject> analyticObjects;
    std::vector<Material> materialFactors; // by material index, for the analytic objects

    // `culledTriangles`: cull_triangles has tested the triangles of the runs that it tests.
    DrawRange drawsOf(const Run& run, bool culledTriangles) const
    {
        return run.tested && culledTriangles
                   ? DrawRange{triangles.draws.get(), run.firstPiece, run.pieceCount}
                   : DrawRange{commands.get(), run.firstCommand, run.commandCount};
    }

    gpu::Buffer staging;
    std::vector<Copy> copies;
    std::vector<TextureCopy> textureCopies;
};

} // namespace candelabra::gbuffer
