// SPDX-License-Identifier: Apache-2.0
#include "gpu/display_format.h"

#include "gpu/format_name.h"
#include "gpu/image_format.h"

namespace candelabra::gpu
{

VkFormat checkedDisplayFormat(const Device& device, const char* member, VkFormat format)
{
    switch (format) {
    case VK_FORMAT_UNDEFINED:
        format = VK_FORMAT_R8G8B8A8_UNORM;
        break;
    case VK_FORMAT_R8G8B8A8_UNORM:
    case VK_FORMAT_B8G8R8A8_UNORM:
    case VK_FORMAT_A2B10G10R10_UNORM_PACK32:
    case VK_FORMAT_A2R10G10B10_UNORM_PACK32:
        break;
    case VK_FORMAT_R8G8B8A8_SRGB:
    case VK_FORMAT_B8G8R8A8_SRGB:
    case VK_FORMAT_A8B8G8R8_SRGB_PACK32:
        failArgument(std::string(member) + " is " + formatName(format) +
                     ", which shaders cannot write: create the image with "
                     "VK_IMAGE_CREATE_MUTABLE_FORMAT_BIT, give a _UNORM view of it, and name that "
                     "view's format here");
    default:
        failArgument(std::string(member) + " is " + formatName(format) +
                     ", must be VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_B8G8R8A8_UNORM, "
                     "VK_FORMAT_A2B10G10R10_UNORM_PACK32 or VK_FORMAT_A2R10G10B10_UNORM_PACK32");
    }
    requireStorage(device, member, format, StorageUse::Write);
    return format;
}

uint32_t lastDisplayStep(VkFormat format)
{
    const bool tenBits = format == VK_FORMAT_A2B10G10R10_UNORM_PACK32 ||
                         format == VK_FORMAT_A2R10G10B10_UNORM_PACK32;
    return tenBits ? 1023 : 255;
}

} // namespace candelabra::gpu
