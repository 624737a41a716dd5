// SPDX-License-Identifier: Apache-2.0
#include "gpu/device.h"

#include <cstdarg>
#include <cstdio>
#include <string_view>

namespace candelabra::gpu
{
Device::Device(const CndDeviceDesc& desc, Parts users)
    : InstanceFunctions(desc),
      parts(users),
      instance(desc.instance),
      physicalDevice(desc.physicalDevice),
      handle(desc.device),
      pipelineCache(desc.pipelineCache),
      allocationCallbacks(desc.allocationCallbacks),
      allocator(desc.allocator),
      message(desc.message),
      messageUser(desc.messageUser),
      apiVersion(checkedVersion(*this, desc))
{
    if (!desc.device)
        failArgument("CndDeviceDesc: device must not be null");
    if (!allocator.allocate != !allocator.free)
        failArgument("CndDeviceDesc: allocator has only one of allocate and free");
    requireNeeds(*this, desc, parts);
#define X(f)                                                                                       \
    f = reinterpret_cast<PFN_vk##f>(GetDeviceProcAddr(handle, "vk" #f));                           \
    if (!f)                                                                                        \
        failUnsupported("the device has no vk" #f);
    CND_DEVICE_FUNCTIONS(X)
    if (parts & rasterPass) {
        CND_RASTER_FUNCTIONS(X)
    }
#undef X
    if (desc.debugUtilsEnabled) {
#define X(f) f = reinterpret_cast<PFN_vk##f>(desc.getInstanceProcAddr(instance, "vk" #f));
        CND_DEBUG_FUNCTIONS(X)
#undef X
        if (!SetDebugUtilsObjectNameEXT)
            say(CND_MESSAGE_WARNING, "CndDeviceDesc: debugUtilsEnabled is set, but there is no "
                                     "vkSetDebugUtilsObjectNameEXT: objects have no names");
    }
    VkPhysicalDeviceProperties2 properties{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2};
    GetPhysicalDeviceProperties2(physicalDevice, &properties);
    limits = properties.properties.limits;
    // The driver's id would say the same, but is not part of Vulkan 1.1.
    lanesAreCpuVector = properties.properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU &&
                        std::string_view(properties.properties.deviceName).starts_with("llvmpipe");
    if (lanesAreCpuVector)
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
    const std::lock_guard lock(usageMutex);
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

} // namespace candelabra::gpu
