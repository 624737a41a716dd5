// SPDX-License-Identifier: Apache-2.0
// Copies images from the GPU to the host, and writes them to files.
#pragma once

#include <cstdint>
#include <vector>

#include "io/image.h"
#include "render/renderer.h"

namespace candelabra::app
{

// Records the copy of all texels of a colour image, which must be in TRANSFER_SRC_OPTIMAL and
// visible to transfers, to the buffer returned. Read the buffer once the GPU has finished.
gpu::Buffer recordReadback(const gpu::Device& device, VkCommandBuffer cmd, VkImage image,
                           PixelSize size, uint32_t texelBytes);

// Returns the texels of a rectangle of an image, rows from the top. The image is in `layout` before
// and after. Waits for the GPU.
std::vector<uint8_t> readTexels(const VulkanContext& context, const gpu::Image& image,
                                VkImageAspectFlags aspect, VkImageLayout layout,
                                const VkRect2D& rect, uint32_t texelBytes);

// Read the last frame of the renderer, which the GPU must have finished: its radiance as 3 channels
// in cd/m^2, or its display image as RGB. Throw gpu::Failure.
Image readRadiance(const VulkanContext& context, const Renderer& renderer);
std::vector<uint8_t> readDisplay(const VulkanContext& context, const Renderer& renderer);

// Returns CndLightingFrame::pairImage of the last heat map, rows from the top. The GPU must have
// finished the frame. Throws gpu::Failure.
std::vector<glm::vec4> readPairs(const VulkanContext& context, const Renderer& renderer);

// Returns the number of triangles of all instances that the last frame of the renderer drew, in
// their levels of detail. The GPU must have finished the frame. Throws gpu::Failure.
uint64_t readDrawnTriangles(const VulkanContext& context, const Renderer& renderer);

// Writes the display image to a .png file, or the radiance to an .exr, .hdr or .pfm file. Throws
// ImageError.
void saveFrame(const VulkanContext& context, const Renderer& renderer, const std::string& path);

// Throws UsageError if saveFrame does not write files with the extension of `path`, so that
// commands can refuse it before any work is done. `option` is the option that the message names.
void requireImageExtension(const std::string& option, const std::string& path);

} // namespace candelabra::app
