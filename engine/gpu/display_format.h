// SPDX-License-Identifier: Apache-2.0
// Formats of images that hold sRGB-encoded values for a display.
#pragma once

#include "gpu/device.h"

namespace candelabra::gpu
{

// Returns the format that the host has chosen, or R8G8B8A8_UNORM for VK_FORMAT_UNDEFINED. Throws
// Failure if kernels cannot write display values to it. `member` names what the host has set.
VkFormat checkedDisplayFormat(const Device& device, const char* member, VkFormat format);

// Returns the largest code of the channels red, green and blue of a display format.
uint32_t lastDisplayStep(VkFormat format);

} // namespace candelabra::gpu
