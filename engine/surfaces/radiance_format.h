// SPDX-License-Identifier: Apache-2.0
// Formats of the scene radiance images to which modules add light.
#pragma once

#include "gpu/image_format.h"

namespace candelabra::surfaces
{

// Returns the format that the host has chosen, or R32G32B32A32_SFLOAT for VK_FORMAT_UNDEFINED.
// Throws gpu::Failure if kernels cannot add light to it. `member` names what the host has set.
VkFormat checkedRadianceFormat(const gpu::Device& device, const char* member, VkFormat format);

// Returns the largest value that every channel of such an image can hold.
float largestRadiance(VkFormat format);

// The code of a kernel that adds light to the image that it binds as `binding`.
inline gpu::FormattedSpirv addingTo(VkFormat format, const gpu::Spirv& spirv, uint32_t binding)
{
    return {spirv, binding, format, gpu::StorageUse::ReadAndWrite};
}

} // namespace candelabra::surfaces
