// SPDX-License-Identifier: Apache-2.0
#include "gbuffer/targets.h"

namespace candelabra::gbuffer
{

TargetFormats targetFormats(CndGBufferLayout layout)
{
    if (layout == CND_GBUFFER_COMPACT)
        return {VK_FORMAT_R32_UINT, VK_FORMAT_R8G8B8A8_SRGB, VK_FORMAT_UNDEFINED,
                VK_FORMAT_D32_SFLOAT, VK_FORMAT_R32G32B32A32_SFLOAT};
    return {VK_FORMAT_R32G32_UINT, VK_FORMAT_R32G32_UINT, VK_FORMAT_R32G32_UINT,
            VK_FORMAT_D32_SFLOAT, VK_FORMAT_R32G32B32A32_SFLOAT};
}

Attachments Targets::attachments() const
{
    const auto of = [](const gpu::Image& i) { return Attachment{i.image.get(), i.view.get()}; };
    return {of(normalRoughness), of(albedo), of(radiance), of(depth), of(specular)};
}

Targets createTargets(const gpu::Device& device, CndGBufferLayout layout, uint32_t width,
                      uint32_t height)
{
    const TargetFormats formats = targetFormats(layout);
    constexpr VkImageUsageFlags read = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
    constexpr VkImageUsageFlags color = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | read;
    const auto create = [&](const char* name, VkFormat format, VkImageUsageFlags usage,
                            VkImageAspectFlags aspect) {
        return createImage(device, name, format, width, height, usage, aspect);
    };
    Targets t;
    t.layout = layout;
    t.width = width;
    t.height = height;
    t.normalRoughness = create("gbuffer normalRoughness", formats.normalRoughness, color,
                               VK_IMAGE_ASPECT_COLOR_BIT);
    t.albedo = create("gbuffer albedo", formats.albedo, color, VK_IMAGE_ASPECT_COLOR_BIT);
    if (formats.specular != VK_FORMAT_UNDEFINED)
        t.specular = create("gbuffer specular", formats.specular, color, VK_IMAGE_ASPECT_COLOR_BIT);
    t.depth = create("gbuffer depth", formats.depth,
                     VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | read, VK_IMAGE_ASPECT_DEPTH_BIT);
    t.radiance = create("gbuffer radiance", formats.radiance,
                        color | VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT,
                        VK_IMAGE_ASPECT_COLOR_BIT);
    return t;
}

} // namespace candelabra::gbuffer
