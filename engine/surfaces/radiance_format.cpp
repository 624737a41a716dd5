// SPDX-License-Identifier: Apache-2.0
#include "surfaces/radiance_format.h"

#include <limits>
#include <string>

#include "gpu/format_name.h"

namespace candelabra::surfaces
{

VkFormat checkedRadianceFormat(const gpu::Device& device, const char* member, VkFormat format)
{
    if (format == VK_FORMAT_UNDEFINED)
        format = VK_FORMAT_R32G32B32A32_SFLOAT;
    if (format != VK_FORMAT_R32G32B32A32_SFLOAT && format != VK_FORMAT_R16G16B16A16_SFLOAT &&
        format != VK_FORMAT_B10G11R11_UFLOAT_PACK32)
        gpu::failArgument(std::string(member) + " is " + gpu::formatName(format) +
                          ", must be VK_FORMAT_R32G32B32A32_SFLOAT, VK_FORMAT_R16G16B16A16_SFLOAT "
                          "or VK_FORMAT_B10G11R11_UFLOAT_PACK32");
    gpu::requireStorage(device, member, format, gpu::StorageUse::ReadAndWrite);
    return format;
}

float largestRadiance(VkFormat format)
{
    switch (format) {
    case VK_FORMAT_R16G16B16A16_SFLOAT:
        return 65504;
    case VK_FORMAT_B10G11R11_UFLOAT_PACK32:
        return 64512; // of blue, which has a bit of mantissa less than red and green
    default:
        return std::numeric_limits<float>::max();
    }
}

} // namespace candelabra::surfaces
