// SPDX-License-Identifier: Apache-2.0
// What the mock driver says of its physical device.
#pragma once

#include <string>

#include <vulkan/vulkan_core.h>

namespace candelabra::test
{

// By its name without vk; null: not there.
PFN_vkVoidFunction physicalDeviceFunction(const std::string& name);

} // namespace candelabra::test
