// SPDX-License-Identifier: Apache-2.0
// Barriers for images with one mip level. An ImageAccess says who uses the image before or after.
#pragma once

#include <vulkan/vulkan.h>

namespace candelabra::app
{

struct ImageAccess {
    VkPipelineStageFlags2 stage;
    VkAccessFlags2 access;
    VkImageLayout layout;
};
inline constexpr ImageAccess computeWrite{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                                          VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
                                          VK_IMAGE_LAYOUT_GENERAL};
inline constexpr ImageAccess computeRead{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                                         VK_ACCESS_2_SHADER_SAMPLED_READ_BIT,
                                         VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
inline constexpr ImageAccess transferRead{VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT,
                                          VK_ACCESS_2_TRANSFER_READ_BIT,
                                          VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL};
inline constexpr ImageAccess transferWrite{VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT,
                                           VK_ACCESS_2_TRANSFER_WRITE_BIT,
                                           VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL};
inline constexpr ImageAccess colorAttachment{VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                                             VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT |
                                                 VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT,
                                             VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
// The state before of an image whose contents are no longer needed. The barrier waits for
// transfers, because nothing else may still be reading the image.
inline constexpr ImageAccess discarded{VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_NONE,
                                       VK_IMAGE_LAYOUT_UNDEFINED};

VkImageMemoryBarrier2 imageBarrier(VkImage image, VkImageAspectFlags aspect,
                                   const ImageAccess& from, const ImageAccess& to);

void transition(VkCommandBuffer cmd, VkImage image, const ImageAccess& from, const ImageAccess& to,
                VkImageAspectFlags aspect = VK_IMAGE_ASPECT_COLOR_BIT);

// Sets all texels to 0. Afterwards the image is in GENERAL, and compute shaders may read and write
// it.
void clearForCompute(VkCommandBuffer cmd, VkImage image, const ImageAccess& from);

} // namespace candelabra::app
