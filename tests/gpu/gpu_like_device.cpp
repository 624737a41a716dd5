// SPDX-License-Identifier: Apache-2.0
#include "gpu/gpu_like_device.h"

#include <string_view>

namespace candelabra::test
{
namespace
{

// Global because Vulkan's function pointers carry no context.
PFN_vkGetInstanceProcAddr hostGetInstanceProcAddr = nullptr;
PFN_vkGetPhysicalDeviceProperties2 hostGetProperties = nullptr;

void VKAPI_CALL propertiesOfAnotherDevice(VkPhysicalDevice device,
                                          VkPhysicalDeviceProperties2* properties)
{
    hostGetProperties(device, properties);
    properties->properties.deviceType = VK_PHYSICAL_DEVICE_TYPE_OTHER;
}

PFN_vkVoidFunction VKAPI_CALL gpuLikeProcAddr(VkInstance instance, const char* name)
{
    if (std::string_view(name) == "vkGetPhysicalDeviceProperties2")
        return reinterpret_cast<PFN_vkVoidFunction>(propertiesOfAnotherDevice);
    return hostGetInstanceProcAddr(instance, name);
}

} // namespace

CndDeviceDesc gpuLike(const CndDeviceDesc& host)
{
    hostGetInstanceProcAddr = host.getInstanceProcAddr;
    hostGetProperties = reinterpret_cast<PFN_vkGetPhysicalDeviceProperties2>(
        host.getInstanceProcAddr(host.instance, "vkGetPhysicalDeviceProperties2"));
    CndDeviceDesc desc = host;
    desc.getInstanceProcAddr = gpuLikeProcAddr;
    return desc;
}

} // namespace candelabra::test
