// SPDX-License-Identifier: Apache-2.0
#include "gpu/device.h"

#include <algorithm>
#include <cstdarg>
#include <cstdio>

namespace candelabra::gpu
{
namespace
{

// The only list of the features that the engine uses: X(struct, member).
#define CND_REQUIRED_FEATURES(X)                                                                   \
    X(core10, multiDrawIndirect)                                                                   \
    X(core10, drawIndirectFirstInstance)                                                           \
    X(core12, scalarBlockLayout)                                                                   \
    X(core13, synchronization2)                                                                    \
    X(core13, dynamicRendering)                                                                    \
    X(core13, maintenance4)                                                                        \
    X(core13, shaderTerminateInvocation)

// Limits that must exceed Vulkan's guaranteed minimum: X(limit, least value).
#define CND_REQUIRED_LIMITS(X)                                                                     \
    X(maxComputeWorkGroupInvocations, 256) /* exposure: a lane per histogram bin */                \
    X(maxComputeWorkGroupSize[0], 256)                                                             \
    X(maxPerStageDescriptorStorageBuffers, maxStorageBuffers)

struct FormatNeed {
    VkFormat format;
    const char* name;
    VkFormatFeatureFlags optimal, buffer;
};

constexpr FormatNeed formatNeeds[] = {
    {VK_FORMAT_R32G32B32A32_SFLOAT, "R32G32B32A32_SFLOAT",
     VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT | VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT |
         VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BIT,
     VK_FORMAT_FEATURE_UNIFORM_TEXEL_BUFFER_BIT},
    {VK_FORMAT_R8G8B8A8_UNORM, "R8G8B8A8_UNORM", VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT, 0},
    {VK_FORMAT_D32_SFLOAT, "D32_SFLOAT",
     VK_FORMAT_FEATURE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT, 0},
};

} // namespace

Device::Device(const CndDeviceDesc& desc)
    : instance(desc.instance),
      physicalDevice(desc.physicalDevice),
      handle(desc.device),
      pipelineCache(desc.pipelineCache),
      allocationCallbacks(desc.allocationCallbacks),
      allocator(desc.allocator),
      message(desc.message),
      messageUser(desc.messageUser)
{
    if (desc.structSize != sizeof desc)
        failArgument("CndDeviceDesc: structSize is " + std::to_string(desc.structSize) +
                     ", this library expects " + std::to_string(sizeof desc));
    if (!desc.instance || !desc.physicalDevice || !desc.device || !desc.getInstanceProcAddr)
        failArgument("CndDeviceDesc: instance, physicalDevice, device and getInstanceProcAddr must "
                     "not be null");
    if (!allocator.allocate != !allocator.free)
        failArgument("CndDeviceDesc: allocator has only one of allocate and free");
#define X(f)                                                                                       \
    f = reinterpret_cast<PFN_vk##f>(desc.getInstanceProcAddr(instance, "vk" #f));                  \
    if (!f)                                                                                        \
        failUnsupported("the host's vkGetInstanceProcAddr has no vk" #f);
    CND_INSTANCE_FUNCTIONS(X)
#undef X
#define X(f)                                                                                       \
    f = reinterpret_cast<PFN_vk##f>(GetDeviceProcAddr(handle, "vk" #f));                           \
    if (!f)                                                                                        \
        failUnsupported("the device has no vk" #f " (Vulkan 1.3 is needed)");
    CND_DEVICE_FUNCTIONS(X)
#undef X
    if (desc.debugUtilsEnabled) {
#define X(f) f = reinterpret_cast<PFN_vk##f>(desc.getInstanceProcAddr(instance, "vk" #f));
        CND_DEBUG_FUNCTIONS(X)
#undef X
        if (!SetDebugUtilsObjectNameEXT)
            say(CND_MESSAGE_WARNING, "CndDeviceDesc: debugUtilsEnabled is set, but there is no "
                                     "vkSetDebugUtilsObjectNameEXT: objects have no names");
    }
    VkPhysicalDeviceDriverProperties driver{
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES};
    VkPhysicalDeviceProperties2 properties{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2,
                                           .pNext = &driver};
    GetPhysicalDeviceProperties2(physicalDevice, &properties);
    limits = properties.properties.limits;
    lanesAreCpuVector = driver.driverID == VK_DRIVER_ID_MESA_LLVMPIPE;
    if (driver.driverID == VK_DRIVER_ID_MESA_LLVMPIPE)
        maxLoopIterations = 65535;
    GetPhysicalDeviceMemoryProperties(physicalDevice, &memory);
}

void Device::name(VkObjectType type, uint64_t object, const std::string& text) const
{
    if (!SetDebugUtilsObjectNameEXT)
        return;
    const VkDebugUtilsObjectNameInfoEXT info{.sType =
                                                 VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT,
                                             .objectType = type,
                                             .objectHandle = object,
                                             .pObjectName = text.c_str()};
    SetDebugUtilsObjectNameEXT(handle, &info);
}

void Device::readUsage(CndMemoryUsage& out) const
{
    if (out.structSize != sizeof out)
        failArgument("CndMemoryUsage: structSize is " + std::to_string(out.structSize) +
                     ", this library expects " + std::to_string(sizeof out));
    out = usage;
    out.structSize = sizeof out;
}

void Device::say(CndMessageSeverity severity, const char* format, ...) const noexcept
{
    if (!message)
        return;
    char sentence[512];
    va_list arguments;
    va_start(arguments, format);
    std::vsnprintf(sentence, sizeof sentence, format, arguments);
    va_end(arguments);
    message(messageUser, severity, sentence);
}

void Device::beginLabel(VkCommandBuffer cmd, const char* text) const
{
    if (!CmdBeginDebugUtilsLabelEXT)
        return;
    const VkDebugUtilsLabelEXT label{.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_LABEL_EXT,
                                     .pLabelName = text};
    CmdBeginDebugUtilsLabelEXT(cmd, &label);
}

void Device::endLabel(VkCommandBuffer cmd) const
{
    if (CmdEndDebugUtilsLabelEXT)
        CmdEndDebugUtilsLabelEXT(cmd);
}

uint32_t Device::memoryType(uint32_t typeBits, VkMemoryPropertyFlags required,
                            VkMemoryPropertyFlags preferred) const
{
    for (const VkMemoryPropertyFlags wanted : {required | preferred, required})
        for (uint32_t i = 0; i < memory.memoryTypeCount; ++i)
            if ((typeBits >> i & 1) && (memory.memoryTypes[i].propertyFlags & wanted) == wanted)
                return i;
    failUnsupported("the device has no memory type with property flags " +
                    std::to_string(required));
}

std::vector<std::string> missingFeatures(VkInstance instance, VkPhysicalDevice physicalDevice,
                                         PFN_vkGetInstanceProcAddr getInstanceProcAddr)
{
    const auto getProperties = reinterpret_cast<PFN_vkGetPhysicalDeviceProperties>(
        getInstanceProcAddr(instance, "vkGetPhysicalDeviceProperties"));
    const auto getFeatures = reinterpret_cast<PFN_vkGetPhysicalDeviceFeatures2>(
        getInstanceProcAddr(instance, "vkGetPhysicalDeviceFeatures2"));
    if (!getProperties || !getFeatures)
        return {"an instance of Vulkan 1.1 or newer"};
    VkPhysicalDeviceProperties properties{};
    getProperties(physicalDevice, &properties);
    std::vector<std::string> missing;
    if (properties.apiVersion < VK_API_VERSION_1_3)
        return {"Vulkan 1.3 (the device has " +
                std::to_string(VK_API_VERSION_MAJOR(properties.apiVersion)) + "." +
                std::to_string(VK_API_VERSION_MINOR(properties.apiVersion)) + ")"};

    VkPhysicalDeviceVulkan13Features core13{
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};
    VkPhysicalDeviceVulkan12Features core12{
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES, .pNext = &core13};
    VkPhysicalDeviceFeatures2 features{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2,
                                       .pNext = &core12};
    getFeatures(physicalDevice, &features);
    const VkPhysicalDeviceFeatures& core10 = features.features;
#define X(which, member)                                                                           \
    if (!which.member)                                                                             \
        missing.emplace_back("feature " #member);
    CND_REQUIRED_FEATURES(X)
#undef X
#define X(limit, least)                                                                            \
    if (properties.limits.limit < least)                                                           \
        missing.emplace_back(#limit " of at least " #least);
    CND_REQUIRED_LIMITS(X)
#undef X

    VkPhysicalDeviceVulkan11Properties core11{
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_PROPERTIES};
    VkPhysicalDeviceProperties2 properties2{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2,
                                            .pNext = &core11};
    const auto getProperties2 = reinterpret_cast<PFN_vkGetPhysicalDeviceProperties2>(
        getInstanceProcAddr(instance, "vkGetPhysicalDeviceProperties2"));
    if (!getProperties2)
        return {"an instance of Vulkan 1.1 or newer"};
    getProperties2(physicalDevice, &properties2);
    constexpr VkSubgroupFeatureFlags subgroupNeeds = // used by count_pairs and cluster_lists
        VK_SUBGROUP_FEATURE_BASIC_BIT | VK_SUBGROUP_FEATURE_VOTE_BIT |
        VK_SUBGROUP_FEATURE_ARITHMETIC_BIT | VK_SUBGROUP_FEATURE_BALLOT_BIT;
    if ((core11.subgroupSupportedOperations & subgroupNeeds) != subgroupNeeds ||
        !(core11.subgroupSupportedStages & VK_SHADER_STAGE_COMPUTE_BIT))
        missing.emplace_back("subgroup votes, ballots and arithmetic in compute shaders");

    const auto getFormat = reinterpret_cast<PFN_vkGetPhysicalDeviceFormatProperties>(
        getInstanceProcAddr(instance, "vkGetPhysicalDeviceFormatProperties"));
    for (const FormatNeed& need : formatNeeds) {
        VkFormatProperties format{};
        getFormat(physicalDevice, need.format, &format);
        if ((format.optimalTilingFeatures & need.optimal) != need.optimal ||
            (format.bufferFeatures & need.buffer) != need.buffer)
            missing.push_back(std::string("usages of format ") + need.name);
    }

    // Every GPU has such memory. Drivers that compile for a GPU which is not there have none.
    constexpr VkMemoryPropertyFlags mapped =
        VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    const auto getMemory = reinterpret_cast<PFN_vkGetPhysicalDeviceMemoryProperties>(
        getInstanceProcAddr(instance, "vkGetPhysicalDeviceMemoryProperties"));
    VkPhysicalDeviceMemoryProperties memory{};
    getMemory(physicalDevice, &memory);
    if (std::none_of(
            memory.memoryTypes, memory.memoryTypes + memory.memoryTypeCount,
            [](const VkMemoryType& type) { return (type.propertyFlags & mapped) == mapped; }))
        missing.emplace_back("memory that the CPU can write");
    return missing;
}

void requireFeatures(VkPhysicalDeviceFeatures& core10, VkPhysicalDeviceVulkan12Features& core12,
                     VkPhysicalDeviceVulkan13Features& core13)
{
#define X(which, member) which.member = VK_TRUE;
    CND_REQUIRED_FEATURES(X)
#undef X
}

} // namespace candelabra::gpu
