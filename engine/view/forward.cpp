// SPDX-License-Identifier: Apache-2.0
#include "view/forward.h"

namespace candelabra::lighting
{
namespace
{

constexpr const char* name = "forward lights";

std::vector<gpu::ReflectedBinding> bindings()
{
    constexpr VkDescriptorType storage = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    constexpr VkDescriptorType texels = VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER;
    return {{gpu::FORWARD_VIEW, storage, 1},   {gpu::FORWARD_CORE, storage, 1},
            {gpu::FORWARD_SHAPES, storage, 1}, {gpu::FORWARD_NODES, storage, 1},
            {gpu::FORWARD_DFG, texels, 1},     {gpu::FORWARD_IDS, storage, 1}};
}

VkPipelineStageFlags2 stagesOf(VkShaderStageFlags shaders)
{
    VkPipelineStageFlags2 stages = 0;
    if (shaders & VK_SHADER_STAGE_VERTEX_BIT)
        stages |= VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT;
    if (shaders & VK_SHADER_STAGE_FRAGMENT_BIT)
        stages |= VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT;
    if (shaders & VK_SHADER_STAGE_COMPUTE_BIT)
        stages |= VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
    return stages;
}

constexpr VkPipelineStageFlags2 ourStages =
    VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT;

void recordBarrier(const gpu::Frame& frame, const VkMemoryBarrier2& barrier) noexcept
{
    const VkDependencyInfo info{.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
                                .memoryBarrierCount = 1,
                                .pMemoryBarriers = &barrier};
    frame.device.CmdPipelineBarrier2(frame.cmd, &info);
}

} // namespace

gpu::Handle<VkDescriptorSetLayout> createForwardLayout(const gpu::Device& device,
                                                       VkShaderStageFlags stages)
{
    constexpr VkShaderStageFlags known =
        VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT | VK_SHADER_STAGE_COMPUTE_BIT;
    if (stages & ~known)
        gpu::failArgument("CndLightingDesc: forwardStages may have the vertex, the fragment and "
                          "the compute stage");
    return stages ? gpu::createSetLayout(device, name, bindings(), stages)
                  : gpu::Handle<VkDescriptorSetLayout>();
}

ForwardLights::ForwardLights(const gpu::Device& device, VkShaderStageFlags stages, uint32_t slots)
    : stages_(stages),
      view_(gpu::createBuffer(device, name, sizeof(gpu::ForwardView),
                              VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                              gpu::MemoryUse::Scratch)),
      sets_(device, name, bindings(), stages, slots)
{
}

void ForwardLights::write(uint32_t slot, const Inputs& in) const
{
    using gpu::Binding;
    sets_.write(slot,
                {Binding::of(gpu::FORWARD_VIEW, view_), Binding::of(gpu::FORWARD_CORE, in.core),
                 Binding::of(gpu::FORWARD_SHAPES, in.shapes),
                 Binding::of(gpu::FORWARD_NODES, in.nodes),
                 Binding::ofTexels(gpu::FORWARD_DFG, in.directionalAlbedo),
                 Binding::of(gpu::FORWARD_IDS, in.ids)});
}

void ForwardLights::recordBegin(const gpu::Frame& frame,
                                const gpu::ForwardView& view) const noexcept
{
    if (!wanted())
        return;
    recordBarrier(frame, {.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,
                          .srcStageMask = stagesOf(stages_),
                          .dstStageMask = ourStages});
    frame.device.CmdUpdateBuffer(frame.cmd, view_.get(), 0, sizeof view, &view);
}

void ForwardLights::recordEnd(const gpu::Frame& frame) const noexcept
{
    if (!wanted())
        return;
    recordBarrier(frame, {.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,
                          .srcStageMask = ourStages,
                          .srcAccessMask =
                              VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT | VK_ACCESS_2_TRANSFER_WRITE_BIT,
                          .dstStageMask = stagesOf(stages_),
                          .dstAccessMask = VK_ACCESS_2_SHADER_STORAGE_READ_BIT |
                                           VK_ACCESS_2_SHADER_SAMPLED_READ_BIT});
}

} // namespace candelabra::lighting
