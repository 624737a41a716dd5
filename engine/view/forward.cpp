// SPDX-License-Identifier: Apache-2.0
#include "view/forward.h"

#include "shared/occluder_data.h"

namespace candelabra::lighting
{
namespace
{

constexpr const char* name = "forward lights";

std::vector<gpu::ReflectedBinding> bindings(ForwardShadows shadows)
{
    constexpr VkDescriptorType storage = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    constexpr VkDescriptorType texels = VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER;
    std::vector<gpu::ReflectedBinding> out = {
        {gpu::FORWARD_VIEW, storage, 1},   {gpu::FORWARD_CORE, storage, 1},
        {gpu::FORWARD_SHAPES, storage, 1}, {gpu::FORWARD_NODES, storage, 1},
        {gpu::FORWARD_DFG, texels, 1},     {gpu::FORWARD_IDS, storage, 1}};
    if (shadows == ForwardShadows::None)
        return out;
    const bool rays = shadows == ForwardShadows::OfRays;
    if (!rays)
        for (const uint32_t binding :
             {gpu::SHADOW_INSTANCES, gpu::SHADOW_NODES, gpu::SHADOW_TRIANGLES})
            out.push_back({binding, storage, 1});
    out.push_back({gpu::SHADOW_POINTS, texels, 1});
    out.push_back(
        {rays ? gpu::SHADOW_VIEW_OF_RAYS : gpu::SHADOW_VIEW, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 1});
    return out;
}

VkPipelineStageFlags stagesOf(VkShaderStageFlags shaders)
{
    VkPipelineStageFlags stages = 0;
    if (shaders & VK_SHADER_STAGE_VERTEX_BIT)
        stages |= VK_PIPELINE_STAGE_VERTEX_SHADER_BIT;
    if (shaders & VK_SHADER_STAGE_FRAGMENT_BIT)
        stages |= VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT;
    if (shaders & VK_SHADER_STAGE_COMPUTE_BIT)
        stages |= VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT;
    return stages;
}

constexpr VkPipelineStageFlags ourStages =
    VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT;

} // namespace

ForwardShadows forwardShadows(const CndLightingDesc& desc, const surfaces::HostKernels& kernels)
{
    return !desc.shadows.points    ? ForwardShadows::None
           : kernels.findsPoints() ? ForwardShadows::OfRays
                                   : ForwardShadows::OfOccluders;
}

gpu::Handle<VkDescriptorSetLayout>
createForwardLayout(const gpu::Device& device, VkShaderStageFlags stages, ForwardShadows shadows)
{
    constexpr VkShaderStageFlags known =
        VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT | VK_SHADER_STAGE_COMPUTE_BIT;
    if (stages & ~known)
        gpu::failArgument("CndLightingDesc: forwardStages may have the vertex, the fragment and "
                          "the compute stage");
    return stages ? gpu::createSetLayout(device, name, bindings(shadows), stages)
                  : gpu::Handle<VkDescriptorSetLayout>();
}

ForwardLights::ForwardLights(const gpu::Device& device, VkShaderStageFlags stages,
                             ForwardShadows shadows, uint32_t slots)
    : stages_(stages),
      view_(gpu::createBuffer(device, name, sizeof(gpu::ForwardView),
                              VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                              gpu::MemoryUse::Scratch)),
      sets_(device, name, bindings(shadows), stages, slots)
{
}

void ForwardLights::write(uint32_t slot, const Inputs& in,
                          std::span<const gpu::Binding> shadows) const
{
    using gpu::Binding;
    sets_.write(slot,
                {Binding::of(gpu::FORWARD_VIEW, view_), Binding::of(gpu::FORWARD_CORE, in.core),
                 Binding::of(gpu::FORWARD_SHAPES, in.shapes),
                 Binding::of(gpu::FORWARD_NODES, in.nodes),
                 Binding::ofTexels(gpu::FORWARD_DFG, in.directionalAlbedo),
                 Binding::of(gpu::FORWARD_IDS, in.ids)},
                shadows);
}

void ForwardLights::recordBegin(const gpu::Frame& frame,
                                const gpu::ForwardView& view) const noexcept
{
    if (!wanted())
        return;
    frame.memoryBarrier(stagesOf(stages_), 0, ourStages, 0);
    frame.device.CmdUpdateBuffer(frame.cmd, view_.get(), 0, sizeof view, &view);
}

void ForwardLights::recordEnd(const gpu::Frame& frame) const noexcept
{
    if (!wanted())
        return;
    frame.memoryBarrier(ourStages, VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_TRANSFER_WRITE_BIT,
                        stagesOf(stages_), VK_ACCESS_SHADER_READ_BIT);
}

} // namespace candelabra::lighting
