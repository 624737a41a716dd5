// SPDX-License-Identifier: Apache-2.0
// The graphics pipelines of the raster pass.
#pragma once

#include <array>

#include "gbuffer/batches.h"
#include "gbuffer/emitters.h"
#include "gpu/kernel.h"

namespace candelabra::gbuffer
{

// Dynamic state of all of them: viewport, scissor, cull mode, front face, depth comparison.
struct Pipelines {
    Pipelines(const gpu::Device& device, CndGBufferLayout layout);

    gpu::Handle<VkDescriptorSetLayout> meshSet, raySet;
    gpu::Handle<VkPipelineLayout> meshLayout, analyticLayout, emitterLayout;
    std::array<gpu::Handle<VkPipeline>, size_t(Variant::Count)> mesh;
    std::array<gpu::Handle<VkPipeline>, 2> analytic;                       // by ANALYTIC_*
    std::array<gpu::Handle<VkPipeline>, Emitters::shapes.size()> emitters; // as Emitters::shapes
};

// Vertex buffer bindings of the mesh pipelines; the emitter pipeline has binding 0 alone.
enum MeshStream : uint32_t { StreamCore, StreamDetail, StreamInstance, StreamCount };

// Set 0 of the ray-cast pipelines.
std::vector<gpu::ReflectedBinding> rayBindings();

} // namespace candelabra::gbuffer
