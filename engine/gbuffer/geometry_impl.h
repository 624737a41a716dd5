// SPDX-License-Identifier: Apache-2.0
// What a Geometry owns, as GBuffer sees it.
#pragma once

#include <vector>

#include "gbuffer/batches.h"
#include "gbuffer/geometry.h"
#include "gpu/kernel.h"
#include "gpu/memory.h"

namespace candelabra::gbuffer
{

// Set 0 of the mesh shaders: the union of both stages' bindings.
std::vector<gpu::ReflectedBinding> meshBindings();

struct Geometry::Impl {
    // A part of the staging buffer that goes to a buffer.
    struct Copy {
        VkBuffer target;
        VkBufferCopy region;
    };
    // A part of the staging buffer that goes to all mip levels of textures[index].
    struct TextureCopy {
        uint32_t texture;
        VkDeviceSize offset;
    };

    const gpu::Device* device;
    GeometryCounts counts;

    // vertices holds all VertexCore, then, from detailOffset, all VertexDetail.
    gpu::Buffer vertices, indices;
    VkDeviceSize detailOffset = 0;
    gpu::Buffer instances, materials; // texel buffers
    gpu::Buffer bounds, chunks, bits, chunkCounts, visible, commands;
    uint32_t chunkCount = 0;

    std::vector<gpu::Image> textures; // those of the description, then a white texel
    std::vector<gpu::Handle<VkSampler>> samplers;
    gpu::Bindings meshSets; // one set per texture set
    gpu::Bindings cullSet, compactSet;

    std::vector<Run> runs;
    std::vector<AnalyticObject> analyticObjects;
    std::vector<Material> materialFactors; // by material, for the analytic objects

    gpu::Buffer staging;
    std::vector<Copy> copies;
    std::vector<TextureCopy> textureCopies;
};

} // namespace candelabra::gbuffer
