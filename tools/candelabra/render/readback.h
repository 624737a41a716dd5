// SPDX-License-Identifier: Apache-2.0
// Images from the GPU to the host, in the terms of image files.
#pragma once

#include <cstdint>
#include <vector>

#include "io/image.h"
#include "render/renderer.h"

namespace candelabra::app
{

// Records the copy of all texels of a colour image that is in TRANSFER_SRC_OPTIMAL and visible to
// transfers; the buffer is read once the GPU is done with it.
gpu::Buffer recordReadback(const gpu::Device& device, VkCommandBuffer cmd, VkImage image,
                           PixelSize size, uint32_t texelBytes);

// Texels of a rectangle of an image that is in `layout` and stays there, rows from the top.
std::vector<uint8_t> readTexels(const VulkanContext& context, const gpu::Image& image,
                                VkImageAspectFlags aspect, VkImageLayout layout,
                                const VkRect2D& rect, uint32_t texelBytes);

// The last frame of a renderer that the GPU is done with. Throws gpu::Failure.
Image readRadiance(const VulkanContext& context, const Renderer& renderer); // 3 channels, cd/m^2
std::vector<uint8_t> readDisplay(const VulkanContext& context, const Renderer& renderer); // RGB

// Writes .png (display) or .exr, .hdr, .pfm (radiance). Throws ImageError.
void saveFrame(const VulkanContext& context, const Renderer& renderer, const std::string& path);

// Throws UsageError for other extensions; before any work is done.
void requireImageExtension(const std::string& option, const std::string& path);

} // namespace candelabra::app
