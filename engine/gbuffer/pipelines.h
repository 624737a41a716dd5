// SPDX-License-Identifier: Apache-2.0
// Creates the graphics pipelines of the raster pass.
#pragma once

#include <array>
#include <map>
#include <string>

#include "gbuffer/batches.h"
#include "gbuffer/emitters.h"
#include "gpu/kernel.h"

namespace candelabra::gbuffer
{

// All pipelines have the same dynamic state: viewport, scissor, cull mode, front face, depth
// comparison.
class Pipelines
{
public:
    // Creates all pipelines but those of meshes.
    Pipelines(const gpu::Device& device, CndGBufferLayout layout);
    // Creates the pipeline of a variant if there is none yet.
    void prepareMesh(const MeshVariant& variant);

    // The variant must have been prepared.
    VkPipeline mesh(const MeshVariant& variant) const { return meshes_.at(variant).pipeline.get(); }

    gpu::Handle<VkDescriptorSetLayout> meshSet, raySet;
    gpu::Handle<VkPipelineLayout> meshLayout; // that of each variant is the same but for its name
    gpu::Handle<VkPipelineLayout> analyticLayout, backgroundLayout, emitterLayout;
    std::array<gpu::Handle<VkPipeline>, 2> analytic; // by ANALYTIC_*
    gpu::Handle<VkPipeline> background;
    // in the order of Emitters::shapes
    std::array<gpu::Handle<VkPipeline>, Emitters::shapes.size()> emitters;

private:
    struct Mesh {
        gpu::Handle<VkPipelineLayout> layout;
        gpu::Handle<VkPipeline> pipeline;
    };
    gpu::Handle<VkPipelineLayout> createMeshLayout(const std::string& name) const;

    const gpu::Device* device_;
    CndGBufferLayout layout_;
    std::map<MeshVariant, Mesh> meshes_;
};

// Vertex buffer bindings of the mesh pipelines, and of the emitter pipelines.
enum MeshStream : uint32_t { StreamCore, StreamDetail, StreamInstance, StreamCount };
enum EmitterStream : uint32_t { StreamEmitter, StreamCorners };

// Bindings of descriptor set 0 in the ray-cast pipelines.
std::vector<gpu::ReflectedBinding> rayBindings();

} // namespace candelabra::gbuffer
