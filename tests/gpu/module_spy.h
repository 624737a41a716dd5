// SPDX-License-Identifier: Apache-2.0
// Shows tests the buffers inside a module: stands between the module and Vulkan, remembers buffers
// by their debug names, and calls the test when the module records a pass.
#pragma once

#include <functional>
#include <map>
#include <string>

#include "harness/gpu_fixture.h"

namespace candelabra::test
{

// Only one may exist at a time, because Vulkan's function pointers carry no context. The host must
// have VK_EXT_debug_utils.
class ModuleSpy
{
public:
    explicit ModuleSpy(const CndDeviceDesc& host);
    ~ModuleSpy();
    ModuleSpy(const ModuleSpy&) = delete;
    ModuleSpy& operator=(const ModuleSpy&) = delete;

    struct Seen {
        VkBuffer buffer = VK_NULL_HANDLE;
        VkDeviceSize size = 0;
    };

    // For the creation of the module.
    const CndDeviceDesc& desc() const { return desc_; }
    // Returns the buffer that got this name last. It can be copied from and filled.
    const Seen& buffer(const std::string& name) const { return named_.at(name); }
    // Called before the commands of a pass are recorded, with the name of the pass.
    std::function<void(VkCommandBuffer, const std::string& pass)> onPass;

private:
    friend struct SpiedFunctions;
    CndDeviceDesc desc_;
    PFN_vkGetInstanceProcAddr getInstanceProcAddr_ = nullptr;
    PFN_vkGetDeviceProcAddr getDeviceProcAddr_ = nullptr;
    PFN_vkCreateBuffer createBuffer_ = nullptr;
    PFN_vkSetDebugUtilsObjectNameEXT setName_ = nullptr;
    PFN_vkCmdBeginDebugUtilsLabelEXT beginLabel_ = nullptr;
    std::map<VkBuffer, VkDeviceSize> sizes_;
    std::map<std::string, Seen> named_;
};

} // namespace candelabra::test
