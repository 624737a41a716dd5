// SPDX-License-Identifier: Apache-2.0
#include "gbuffer/pass_barriers.h"

namespace candelabra::gbuffer
{
namespace
{

struct Access {
    VkPipelineStageFlags2 stage;
    VkAccessFlags2 access;
    VkImageLayout layout;
};

constexpr VkPipelineStageFlags2 depthStages =
    VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT;
constexpr VkAccessFlags2 depthAccess =
    VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT | VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT;
// The last use of the host's images is unknown, so wait for everything.
constexpr Access anything{VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_WRITE_BIT,
                          VK_IMAGE_LAYOUT_UNDEFINED};
constexpr Access colorAttachment{VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                                 VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT,
                                 VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
constexpr Access depthAttachment{depthStages, depthAccess,
                                 VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL};
constexpr Access computeRead{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                             VK_ACCESS_2_SHADER_SAMPLED_READ_BIT,
                             VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
constexpr Access computeReadWrite{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                                  VK_ACCESS_2_SHADER_STORAGE_READ_BIT |
                                      VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
                                  VK_IMAGE_LAYOUT_GENERAL};

VkImageMemoryBarrier2 imageBarrier(VkImage image, VkImageAspectFlags aspect, const Access& from,
                                   const Access& to)
{
    return {.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2,
            .srcStageMask = from.stage,
            .srcAccessMask = from.access,
            .dstStageMask = to.stage,
            .dstAccessMask = to.access,
            .oldLayout = from.layout,
            .newLayout = to.layout,
            .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
            .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
            .image = image,
            .subresourceRange = {aspect, 0, 1, 0, 1}};
}

void record(const gpu::Device& device, VkCommandBuffer cmd, const VkMemoryBarrier2& memory,
            const VkImageMemoryBarrier2* images, uint32_t imageCount)
{
    const VkDependencyInfo info{.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
                                .memoryBarrierCount = 1,
                                .pMemoryBarriers = &memory,
                                .imageMemoryBarrierCount = imageCount,
                                .pImageMemoryBarriers = images};
    device.CmdPipelineBarrier2(cmd, &info);
}

} // namespace

void waitForEarlierDraws(const gpu::Device& device, VkCommandBuffer cmd) noexcept
{
    record(device, cmd,
           {.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,
            .srcStageMask = VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT |
                            VK_PIPELINE_STAGE_2_VERTEX_ATTRIBUTE_INPUT_BIT |
                            VK_PIPELINE_STAGE_2_INDEX_INPUT_BIT |
                            VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
            .srcAccessMask = VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
            .dstStageMask =
                VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT,
            .dstAccessMask = VK_ACCESS_2_SHADER_STORAGE_READ_BIT |
                             VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT | VK_ACCESS_2_TRANSFER_WRITE_BIT},
           nullptr, 0);
}

void prepareAttachments(const gpu::Device& device, VkCommandBuffer cmd,
                        const Attachments& a) noexcept
{
    constexpr VkImageAspectFlags color = VK_IMAGE_ASPECT_COLOR_BIT;
    const VkImageMemoryBarrier2 images[] = {
        imageBarrier(a.depth.image, VK_IMAGE_ASPECT_DEPTH_BIT, anything, depthAttachment),
        imageBarrier(a.normalRoughness.image, color, anything, colorAttachment),
        imageBarrier(a.albedo.image, color, anything, colorAttachment),
        imageBarrier(a.radiance.image, color, anything, colorAttachment),
        imageBarrier(a.specular.image, color, anything, colorAttachment)};
    record(device, cmd,
           {.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,
            .srcStageMask = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
            .srcAccessMask = VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
            .dstStageMask = VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT |
                            VK_PIPELINE_STAGE_2_VERTEX_ATTRIBUTE_INPUT_BIT |
                            VK_PIPELINE_STAGE_2_INDEX_INPUT_BIT,
            .dstAccessMask = VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT |
                             VK_ACCESS_2_VERTEX_ATTRIBUTE_READ_BIT | VK_ACCESS_2_INDEX_READ_BIT},
           images, a.specular.image ? 5 : 4);
}

void betweenDraws(const gpu::Device& device, VkCommandBuffer cmd) noexcept
{
    const VkPipelineStageFlags2 stages = colorAttachment.stage | depthAttachment.stage;
    record(
        device, cmd,
        {.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,
         .srcStageMask = stages,
         .srcAccessMask = colorAttachment.access | VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT,
         .dstStageMask = stages,
         .dstAccessMask = colorAttachment.access | VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT |
                          depthAttachment.access},
        nullptr, 0);
}

void handToCompute(const gpu::Device& device, VkCommandBuffer cmd, const Attachments& a) noexcept
{
    constexpr VkImageAspectFlags color = VK_IMAGE_ASPECT_COLOR_BIT;
    const VkImageMemoryBarrier2 images[] = {
        imageBarrier(a.depth.image, VK_IMAGE_ASPECT_DEPTH_BIT, depthAttachment, computeRead),
        imageBarrier(a.normalRoughness.image, color, colorAttachment, computeRead),
        imageBarrier(a.albedo.image, color, colorAttachment, computeRead),
        imageBarrier(a.radiance.image, color, colorAttachment, computeReadWrite),
        imageBarrier(a.specular.image, color, colorAttachment, computeRead)};
    const VkDependencyInfo info{.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
                                .imageMemoryBarrierCount = a.specular.image ? 5u : 4u,
                                .pImageMemoryBarriers = images};
    device.CmdPipelineBarrier2(cmd, &info);
}

} // namespace candelabra::gbuffer
