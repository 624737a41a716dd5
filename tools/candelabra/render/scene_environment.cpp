// SPDX-License-Identifier: Apache-2.0
#include "render/scene_upload.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include <fmt/format.h>

#include "gpu/memory.h"
#include "io/error.h"
#include "render/check.h"
#include "render/image_barrier.h"

namespace candelabra::app
{
namespace
{

gpu::Buffer stage(const gpu::Device& device, const Image& image)
{
    const size_t pixels = size_t(image.width) * image.height;
    gpu::Buffer buffer =
        gpu::createBuffer(device, "environment staging", pixels * sizeof(glm::vec4),
                          VK_BUFFER_USAGE_TRANSFER_SRC_BIT, gpu::MemoryUse::Upload);
    const std::span<glm::vec4> out = buffer.as<glm::vec4>();
    const bool grey = image.channels == 1;
    for (size_t i = 0; i < pixels; ++i) {
        const float* in = &image.pixels[i * image.channels];
        out[i] = {in[0], in[grey ? 0 : 1], in[grey ? 0 : 2], 1};
    }
    return buffer;
}

// The side of a cube face that gives the cube map about as many texels around the horizon as the
// image has, between 64 and 1024.
uint32_t cubeSizeFor(const Image& image)
{
    return std::clamp(std::bit_ceil(std::max(image.width / 4, 1u)), 64u, 1024u);
}

} // namespace

Environment uploadEnvironment(const VulkanContext& context, const SceneEnvironment& environment,
                              CndEnvironmentDesc desc)
{
    const Image& radiance = environment.radiance;
    const gpu::Device& device = context.device();
    const uint32_t largest = device.limits.maxImageDimension2D;
    if (std::max(radiance.width, radiance.height) > largest)
        throw UsageError(fmt::format("the environment has {}x{} pixels, {} takes at most {} a side",
                                     radiance.width, radiance.height, context.info().name,
                                     largest));
    desc.cubeSize = cubeSizeFor(radiance);
    Environment out = valueOrThrow(Environment::create(context.desc(), desc));
    const gpu::Image image = gpu::createImage(
        device, "environment image", VK_FORMAT_R32G32B32A32_SFLOAT, radiance.width, radiance.height,
        VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT, VK_IMAGE_ASPECT_COLOR_BIT);
    const gpu::Buffer staging = stage(device, radiance);
    context.submitAndWait([&](VkCommandBuffer cmd) {
        transition(cmd, image.image.get(), discarded, transferWrite);
        const VkBufferImageCopy copy{.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                                     .imageExtent = {radiance.width, radiance.height, 1}};
        vkCmdCopyBufferToImage(cmd, staging.get(), image.image.get(),
                               VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &copy);
        transition(cmd, image.image.get(), transferWrite, computeRead);
        valueOrThrow(out.recordMap(cmd, {.width = radiance.width,
                                         .height = radiance.height,
                                         .equirectangular = image.view.get()}));
    });
    return out;
}

void setEnvironmentRotation(double rotation, float (&worldFromEnvironment)[9])
{
    const float c = float(std::cos(rotation)), s = float(std::sin(rotation));
    const float columns[9] = {c, 0, -s, 0, 1, 0, s, 0, c};
    std::copy_n(columns, 9, worldFromEnvironment);
}

} // namespace candelabra::app
