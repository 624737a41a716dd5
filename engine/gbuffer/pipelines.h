// SPDX-License-Identifier: Apache-2.0
// Creates the graphics pipelines of the raster pass.
#pragma once

#include <array>

#include "gbuffer/batches.h"
#include "gbuffer/emitters.h"
#include "gpu/kernel.h"

namespace candelabra::gbuffer
{

// All pipelines have the same dynamic state: viewport, scissor, cull mode, front face, depth
// comparison.
struct Pipelines {
    Pipelines(const gpu::Device& device, CndGBufferLayout layout);

    gpu::Handle<VkDescriptorSetLayout> meshSet, raySet;
    gpu::Handle<VkPipelineLayout> meshLayout, analyticLayout, emitterLayout;
    std::array<gpu::Handle<VkPipeline>, size_t(Variant::Count)> mesh;
    std::array<gpu::Handle<VkPipeline>, 2> analytic; // by ANALYTIC_*
    // in the order of Emitters::shapes
    std::array<gpu::Handle<VkPipeline>, Emitters::shapes.size()> emitters;
};

// Vertex buffer bindings of the mesh pipelines. The emitter pipelines use binding 0 only.
enum MeshStream : uint32_t { StreamCore, StreamDetail, StreamInstance, StreamCount };

// Bindings of descriptor set 0 in the ray-cast pipelines.
std::vector<gpu::ReflectedBinding> rayBindings();

} // namespace candelabra::gbuffer
