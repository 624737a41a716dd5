// SPDX-License-Identifier: Apache-2.0
// What objects will take, known by making them on Vulkan functions that make nothing: what these
// are asked for is what the device would be asked for, with no list of buffers beside the code.
#pragma once

#include "candelabra/candelabra.h"

namespace candelabra::gpu
{

class Planning
{
public:
    // Throws Failure. One at a time on a thread, which alone uses what is made from desc().
    explicit Planning(const CndDeviceDesc& device);
    ~Planning();
    Planning(const Planning&) = delete;
    Planning& operator=(const Planning&) = delete;

    // The device to create from; only its limits and memory requirements are real.
    const CndDeviceDesc& desc() const { return desc_; }

private:
    static PFN_vkVoidFunction VKAPI_CALL instanceFunction(VkInstance, const char* name);
    static PFN_vkVoidFunction VKAPI_CALL deviceFunction(VkDevice, const char* name);
    static VkResult allocate(void* user, const CndMemoryRequest* request, CndMemory* memory);

    PFN_vkGetInstanceProcAddr getInstanceProcAddr_;
    PFN_vkGetDeviceProcAddr getDeviceProcAddr_ = nullptr;
    CndDeviceDesc desc_;
};

} // namespace candelabra::gpu
