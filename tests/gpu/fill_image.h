// SPDX-License-Identifier: Apache-2.0
// Fills an image that has one mip level.
#pragma once

#include "gpu/memory.h"
#include "harness/gpu_fixture.h"

namespace candelabra::test
{

// Records a copy of `data`, rows without gaps, into an aspect of the image. Afterwards shaders may
// read the image. `beside`: aspects that the image has as well; barriers name all of them.
inline void fillImage(VkCommandBuffer cmd, const gpu::Buffer& data, VkImage image, uint32_t width,
                      uint32_t height, VkImageAspectFlags filled = VK_IMAGE_ASPECT_COLOR_BIT,
                      VkImageAspectFlags beside = 0)
{
    const VkImageAspectFlags all = filled | beside;
    transition(cmd, image, all, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
    const VkBufferImageCopy copy{.imageSubresource = {filled, 0, 0, 1},
                                 .imageExtent = {width, height, 1}};
    vkCmdCopyBufferToImage(cmd, data.get(), image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &copy);
    transition(cmd, image, all, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
               VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
}

} // namespace candelabra::test
