// SPDX-License-Identifier: Apache-2.0
// The images of a G-buffer: formats per layout, and an owner of one set of images.
#pragma once

#include "candelabra/candelabra.h"
#include "gpu/memory.h"

namespace candelabra::gbuffer
{

struct Attachment {
    VkImage image = VK_NULL_HANDLE;
    VkImageView view = VK_NULL_HANDLE;
};

// Borrowed images, all of one size, at least that of the frame.
struct Attachments {
    Attachment normalRoughness, albedo, radiance, depth;
    Attachment specular; // layout FULL only
};

// Formats of the images. Bytes per pixel: FULL 8 + 8 + 8 + 4 + 16 = 44, COMPACT 4 + 4 + 4 + 16 =
// 28.
struct TargetFormats {
    VkFormat normalRoughness, albedo, specular, depth, radiance; // COMPACT: `specular` is UNDEFINED
};
TargetFormats targetFormats(CndGBufferLayout layout);

struct Targets {
    CndGBufferLayout layout = CND_GBUFFER_FULL;
    uint32_t width = 0, height = 0;
    gpu::Image normalRoughness, albedo, specular, depth, radiance;

    Attachments attachments() const;
};

// Creates images that can be used as attachments, sampled and copied from; radiance can also be a
// storage image and be cleared. Throws gpu::Failure.
Targets createTargets(const gpu::Device& device, CndGBufferLayout layout, uint32_t width,
                      uint32_t height);

} // namespace candelabra::gbuffer
