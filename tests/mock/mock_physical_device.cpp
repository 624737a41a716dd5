// SPDX-License-Identifier: Apache-2.0
#include "mock/mock_physical_device.h"

#include <cstring>
#include <utility>

#include "mock/mock_vulkan.h"

namespace candelabra::test
{
namespace
{

template <typename T, typename Visit>
void forEach(void* chain, VkStructureType type, Visit&& visit)
{
    if (MockVulkan::current().ignoresChains)
        return;
    for (auto* s = static_cast<VkBaseOutStructure*>(chain); s; s = s->pNext)
        if (s->sType == type)
            visit(*reinterpret_cast<T*>(s));
}

void VKAPI_CALL properties(VkPhysicalDevice, VkPhysicalDeviceProperties2* out)
{
    const MockVulkan& mock = MockVulkan::current();
    out->properties.apiVersion = mock.apiVersion;
    out->properties.limits = mock.limits;
    out->properties.deviceType =
        mock.isLlvmpipe ? VK_PHYSICAL_DEVICE_TYPE_CPU : VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU;
    std::strcpy(out->properties.deviceName, mock.isLlvmpipe ? "llvmpipe (LLVM 15)" : "mock");
    forEach<VkPhysicalDeviceSubgroupProperties>(
        out->pNext, VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_PROPERTIES, [&](auto& subgroups) {
            subgroups.subgroupSize = 32;
            subgroups.supportedStages = VK_SHADER_STAGE_ALL;
            subgroups.supportedOperations = mock.subgroupOperations;
        });
}

void VKAPI_CALL features(VkPhysicalDevice, VkPhysicalDeviceFeatures2* out)
{
    const auto has = [](const char* feature) {
        return VkBool32(MockVulkan::current().lackingFeature != feature);
    };
    out->features.multiDrawIndirect = has("multiDrawIndirect");
    out->features.drawIndirectFirstInstance = has("drawIndirectFirstInstance");
    forEach<VkPhysicalDeviceScalarBlockLayoutFeatures>(
        out->pNext, VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SCALAR_BLOCK_LAYOUT_FEATURES,
        [&](auto& scalar) { scalar.scalarBlockLayout = has("scalarBlockLayout"); });
    forEach<VkPhysicalDeviceVulkan13Features>(
        out->pNext, VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES, [&](auto& core13) {
            core13.dynamicRendering = has("dynamicRendering");
            core13.synchronization2 = has("synchronization2");
        });
}

VkResult VKAPI_CALL extensions(VkPhysicalDevice, const char*, uint32_t* count,
                               VkExtensionProperties* out)
{
    const std::set<std::string>& names = MockVulkan::current().extensions;
    *count = uint32_t(names.size());
    for (auto name = names.begin(); out && name != names.end(); ++name, ++out)
        std::strcpy(out->extensionName, name->c_str());
    return VK_SUCCESS;
}

void VKAPI_CALL memoryProperties(VkPhysicalDevice, VkPhysicalDeviceMemoryProperties* out)
{
    *out = {.memoryTypeCount = 1,
            .memoryTypes = {{(VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT |
                              VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT |
                              VK_MEMORY_PROPERTY_HOST_COHERENT_BIT) &
                                 ~MockVulkan::current().lackingMemory,
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
    const VkFormatFeatureFlags all = 0x7FFFFFFF & ~MockVulkan::current().lackingFormatFeatures;
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
        {"GetPhysicalDeviceFeatures2", reinterpret_cast<PFN_vkVoidFunction>(features)},
        {"EnumerateDeviceExtensionProperties", reinterpret_cast<PFN_vkVoidFunction>(extensions)},
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
