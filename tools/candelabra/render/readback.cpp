// SPDX-License-Identifier: Apache-2.0
#include "render/readback.h"

#include "io/error.h"
#include "render/image_barrier.h"

namespace candelabra::app
{
namespace
{

gpu::Buffer read(const VulkanContext& context, const gpu::Image& image, uint32_t texelBytes)
{
    gpu::Buffer buffer;
    context.submitAndWait([&](VkCommandBuffer cmd) {
        buffer = recordReadback(context.device(), cmd, image.image.get(),
                                {image.width, image.height}, texelBytes);
    });
    return buffer;
}

void makeVisibleToHost(VkCommandBuffer cmd)
{
    const VkMemoryBarrier2 barrier{.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,
                                   .srcStageMask = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT,
                                   .srcAccessMask = VK_ACCESS_2_TRANSFER_WRITE_BIT,
                                   .dstStageMask = VK_PIPELINE_STAGE_2_HOST_BIT,
                                   .dstAccessMask = VK_ACCESS_2_HOST_READ_BIT};
    const VkDependencyInfo info{.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
                                .memoryBarrierCount = 1,
                                .pMemoryBarriers = &barrier};
    vkCmdPipelineBarrier2(cmd, &info);
}

// Returns the first three of every four values.
template <typename T>
std::vector<T> dropAlpha(std::span<const T> rgba, size_t texels)
{
    std::vector<T> out(texels * 3);
    for (size_t i = 0; i < texels; ++i)
        for (size_t c = 0; c < 3; ++c)
            out[i * 3 + c] = rgba[i * 4 + c];
    return out;
}

} // namespace

std::vector<uint8_t> readTexels(const VulkanContext& context, const gpu::Image& image,
                                VkImageAspectFlags aspect, VkImageLayout layout,
                                const VkRect2D& rect, uint32_t texelBytes)
{
    const gpu::Buffer buffer =
        createBuffer(context.device(), "readback",
                     VkDeviceSize(rect.extent.width) * rect.extent.height * texelBytes,
                     VK_BUFFER_USAGE_TRANSFER_DST_BIT, gpu::MemoryUse::Readback);
    context.submitAndWait([&](VkCommandBuffer cmd) {
        const auto move = [&](VkImageLayout from, VkImageLayout to) {
            constexpr VkPipelineStageFlags2 all = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
            constexpr VkAccessFlags2 writes = VK_ACCESS_2_MEMORY_WRITE_BIT;
            transition(cmd, image.image.get(), {all, writes, from},
                       {all, writes | VK_ACCESS_2_MEMORY_READ_BIT, to}, aspect);
        };
        move(layout, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
        const VkBufferImageCopy region{.imageSubresource = {aspect, 0, 0, 1},
                                       .imageOffset = {rect.offset.x, rect.offset.y, 0},
                                       .imageExtent = {rect.extent.width, rect.extent.height, 1}};
        vkCmdCopyImageToBuffer(cmd, image.image.get(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                               buffer.get(), 1, &region);
        makeVisibleToHost(cmd);
        move(VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, layout);
    });
    const auto bytes = buffer.as<const uint8_t>();
    return {bytes.begin(), bytes.end()};
}

gpu::Buffer recordReadback(const gpu::Device& device, VkCommandBuffer cmd, VkImage image,
                           PixelSize size, uint32_t texelBytes)
{
    gpu::Buffer buffer =
        createBuffer(device, "readback", VkDeviceSize(size.width) * size.height * texelBytes,
                     VK_BUFFER_USAGE_TRANSFER_DST_BIT, gpu::MemoryUse::Readback);
    const VkBufferImageCopy region{.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                                   .imageExtent = {size.width, size.height, 1}};
    vkCmdCopyImageToBuffer(cmd, image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, buffer.get(), 1,
                           &region);
    makeVisibleToHost(cmd);
    return buffer;
}

Image readRadiance(const VulkanContext& context, const Renderer& renderer)
{
    const gpu::Image& image = renderer.radiance();
    const gpu::Buffer buffer = read(context, image, 4 * sizeof(float));
    return {.width = image.width,
            .height = image.height,
            .channels = 3,
            .pixels =
                dropAlpha<float>(buffer.as<const float>(), size_t(image.width) * image.height)};
}

std::vector<uint8_t> readDisplay(const VulkanContext& context, const Renderer& renderer)
{
    const gpu::Image& image = renderer.display();
    const gpu::Buffer buffer = read(context, image, 4);
    return dropAlpha<uint8_t>(buffer.as<const uint8_t>(), size_t(image.width) * image.height);
}

uint64_t readDrawnTriangles(const VulkanContext& context, const Renderer& renderer)
{
    constexpr VkDeviceSize stride = sizeof(VkDrawIndexedIndirectCommand);
    const std::vector<gbuffer::DrawRange> draws = renderer.draws();
    VkDeviceSize size = 0;
    for (const gbuffer::DrawRange& range : draws)
        size += range.count * stride;
    const gpu::Buffer copy =
        gpu::createBuffer(context.device(), "draw commands readback", size,
                          VK_BUFFER_USAGE_TRANSFER_DST_BIT, gpu::MemoryUse::Readback);
    context.submitAndWait([&](VkCommandBuffer cmd) {
        VkBufferCopy region{};
        for (const gbuffer::DrawRange& range : draws) {
            region.srcOffset = range.first * stride;
            region.size = range.count * stride;
            if (region.size)
                vkCmdCopyBuffer(cmd, range.commands, copy.get(), 1, &region);
            region.dstOffset += region.size;
        }
        makeVisibleToHost(cmd);
    });
    uint64_t sum = 0;
    for (const auto& draw : copy.as<VkDrawIndexedIndirectCommand>())
        sum += uint64_t(draw.indexCount / 3) * draw.instanceCount;
    return sum;
}

std::vector<glm::vec4> readPairs(const VulkanContext& context, const Renderer& renderer)
{
    const gpu::Image& pairs = renderer.pairs();
    const std::vector<uint8_t> bytes =
        readTexels(context, pairs, VK_IMAGE_ASPECT_COLOR_BIT, VK_IMAGE_LAYOUT_GENERAL,
                   {{0, 0}, {pairs.width, pairs.height}}, sizeof(glm::vec4));
    std::vector<glm::vec4> out(bytes.size() / sizeof(glm::vec4));
    std::memcpy(out.data(), bytes.data(), bytes.size());
    return out;
}

void saveFrame(const VulkanContext& context, const Renderer& renderer, const std::string& path)
{
    if (isDisplayName(path))
        savePng(path, renderer.size().width, renderer.size().height,
                readDisplay(context, renderer));
    else
        saveImageByExtension(path, readRadiance(context, renderer));
}

void requireImageExtension(const std::string& option, const std::string& path)
{
    if (!isPictureName(path))
        throw UsageError(
            option + " " + path +
            ": the name must end in .png (display) or .exr, .hdr, .pfm (linear radiance)");
}

} // namespace candelabra::app
