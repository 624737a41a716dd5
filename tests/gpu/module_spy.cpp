// SPDX-License-Identifier: Apache-2.0
#include "gpu/module_spy.h"

namespace candelabra::test
{
namespace
{
ModuleSpy* spy = nullptr;
} // namespace

// The functions that the module calls instead of Vulkan's.
struct SpiedFunctions {
    static VkResult VKAPI_CALL createBuffer(VkDevice device, const VkBufferCreateInfo* info,
                                            const VkAllocationCallbacks* callbacks,
                                            VkBuffer* buffer)
    {
        VkBufferCreateInfo copyable = *info;
        copyable.usage |= VK_BUFFER_USAGE_TRANSFER_DST_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT;
        const VkResult result = spy->createBuffer_(device, &copyable, callbacks, buffer);
        if (result == VK_SUCCESS)
            spy->sizes_[*buffer] = info->size;
        return result;
    }

    static VkResult VKAPI_CALL setName(VkDevice device, const VkDebugUtilsObjectNameInfoEXT* info)
    {
        if (info->objectType == VK_OBJECT_TYPE_BUFFER) {
            const auto buffer = reinterpret_cast<VkBuffer>(info->objectHandle);
            spy->named_[info->pObjectName] = {buffer, spy->sizes_[buffer]};
        }
        return spy->setName_(device, info);
    }

    static void VKAPI_CALL beginLabel(VkCommandBuffer cmd, const VkDebugUtilsLabelEXT* label)
    {
        if (spy->onPass)
            spy->onPass(cmd, label->pLabelName);
        spy->beginLabel_(cmd, label);
    }

    static PFN_vkVoidFunction VKAPI_CALL deviceProcAddr(VkDevice device, const char* name)
    {
        if (std::string(name) == "vkCreateBuffer")
            return reinterpret_cast<PFN_vkVoidFunction>(createBuffer);
        return spy->getDeviceProcAddr_(device, name);
    }

    static PFN_vkVoidFunction VKAPI_CALL instanceProcAddr(VkInstance instance, const char* name)
    {
        const std::string function = name;
        if (function == "vkGetDeviceProcAddr")
            return reinterpret_cast<PFN_vkVoidFunction>(deviceProcAddr);
        if (function == "vkSetDebugUtilsObjectNameEXT")
            return reinterpret_cast<PFN_vkVoidFunction>(setName);
        if (function == "vkCmdBeginDebugUtilsLabelEXT")
            return reinterpret_cast<PFN_vkVoidFunction>(beginLabel);
        return spy->getInstanceProcAddr_(instance, name);
    }
};

ModuleSpy::ModuleSpy(const CndDeviceDesc& host)
    : desc_(host), getInstanceProcAddr_(host.getInstanceProcAddr)
{
    const auto find = [&](const char* name) { return getInstanceProcAddr_(host.instance, name); };
    getDeviceProcAddr_ = reinterpret_cast<PFN_vkGetDeviceProcAddr>(find("vkGetDeviceProcAddr"));
    createBuffer_ =
        reinterpret_cast<PFN_vkCreateBuffer>(getDeviceProcAddr_(host.device, "vkCreateBuffer"));
    setName_ =
        reinterpret_cast<PFN_vkSetDebugUtilsObjectNameEXT>(find("vkSetDebugUtilsObjectNameEXT"));
    beginLabel_ =
        reinterpret_cast<PFN_vkCmdBeginDebugUtilsLabelEXT>(find("vkCmdBeginDebugUtilsLabelEXT"));
    EXPECT_TRUE(host.debugUtilsEnabled && setName_ && beginLabel_)
        << "VK_EXT_debug_utils is needed to find buffers by their names";
    desc_.getInstanceProcAddr = SpiedFunctions::instanceProcAddr;
    EXPECT_EQ(spy, nullptr);
    spy = this;
}

ModuleSpy::~ModuleSpy()
{
    spy = nullptr;
}

} // namespace candelabra::test
