// SPDX-License-Identifier: Apache-2.0
// The mock driver's answers about its physical device.
#pragma once

#include <string>

#include <vulkan/vulkan_core.h>

namespace candelabra::test
{

// Returns the function of this name (without "vk"), or null if there is none.
PFN_vkVoidFunction physicalDeviceFunction(const std::string& name);

} // namespace candelabra::test
