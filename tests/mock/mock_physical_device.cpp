// SPDX-License-Identifier: Apache-2.0
#include "mock/mock_physical_device.h"

#include <utility>

#include "mock/mock_vulkan.h"

namespace candelabra::test
{
namespace
{

void VKAPI_CALL properties(VkPhysicalDevice, VkPhysicalDeviceProperties2* out)
{
    out->properties.limits = MockVulkan::current().limits;
    for (auto* s = static_cast<VkBaseOutStructure*>(out->pNext); s; s = s->pNext)
        if (s->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES)
            reinterpret_cast<VkPhysicalDeviceDriverProperties*>(s)->driverID =
                MockVulkan::current().driver;
}

void VKAPI_CALL memoryProperties(VkPhysicalDevice, VkPhysicalDeviceMemoryProperties* out)
{
    *out = {
        .memoryTypeCount = 1,
        .memoryTypes = {{VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT | VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT |
                             VK_MEMORY_PROPERTY_HOST_COHERENT_BIT,
                         0}},
        .memoryHeapCount = 1};
}

void VKAPI_CALL queueFamilies(VkPhysicalDevice, uint32_t* count, VkQueueFamilyProperties* out)
{
    *count = 1;
    if (out)
        *out = {.queueFlags = VK_QUEUE_COMPUTE_BIT, .queueCount = 1, .timestampValidBits = 64};
}

void VKAPI_CALL formatProperties(VkPhysicalDevice, VkFormat, VkFormatProperties2* out)
{
    constexpr VkFormatFeatureFlags all = 0x7FFFFFFF;
    out->formatProperties = {all, all, all};
    auto* const more = static_cast<VkFormatProperties3*>(out->pNext);
    if (more && more->sType == VK_STRUCTURE_TYPE_FORMAT_PROPERTIES_3)
        more->linearTilingFeatures = more->optimalTilingFeatures = more->bufferFeatures = ~0ull;
}

} // namespace

PFN_vkVoidFunction physicalDeviceFunction(const std::string& name)
{
    const std::pair<const char*, PFN_vkVoidFunction> functions[] = {
        {"GetPhysicalDeviceProperties2", reinterpret_cast<PFN_vkVoidFunction>(properties)},
        {"GetPhysicalDeviceMemoryProperties",
         reinterpret_cast<PFN_vkVoidFunction>(memoryProperties)},
        {"GetPhysicalDeviceQueueFamilyProperties",
         reinterpret_cast<PFN_vkVoidFunction>(queueFamilies)},
        {"GetPhysicalDeviceFormatProperties2",
         reinterpret_cast<PFN_vkVoidFunction>(formatProperties)}};
    for (const auto& [known, function] : functions)
        if (name == known)
            return function;
    return nullptr;
}

} // namespace candelabra::test
