// SPDX-License-Identifier: Apache-2.0
// Names of formats, for messages.
#pragma once

#include <string>

#include <vulkan/vulkan_core.h>

namespace candelabra::gpu
{

// Returns "VK_FORMAT_R8G8B8A8_UNORM" and the like; for formats of later versions and of extensions
// "VkFormat" and the number.
std::string formatName(VkFormat format);

} // namespace candelabra::gpu
