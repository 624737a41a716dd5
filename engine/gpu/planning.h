// SPDX-License-Identifier: Apache-2.0
// Planning finds out how much memory and how many pipelines a module will take without creating it,
// and likewise for the raster pass. The module's own code runs with Vulkan functions that create
// buffers and images without memory, and nothing else, so there is no separate list of buffers to
// keep up to date.
#pragma once

#include "candelabra/candelabra.h"

namespace candelabra::gpu
{

// While a Planning exists, objects created from desc() on this thread use no device memory.
class Planning
{
public:
    // Throws Failure. At most one Planning may exist per thread, and only that thread may use the
    // objects created from desc().
    explicit Planning(const CndDeviceDesc& device);
    ~Planning();
    Planning(const Planning&) = delete;
    Planning& operator=(const Planning&) = delete;

    // The device description to create from. Only its limits and memory requirements are real.
    const CndDeviceDesc& desc() const { return desc_; }
    // The number of pipelines that objects created from desc() have asked for.
    uint32_t pipelineCount() const;

private:
    static PFN_vkVoidFunction VKAPI_CALL instanceFunction(VkInstance, const char* name);
    static PFN_vkVoidFunction VKAPI_CALL deviceFunction(VkDevice, const char* name);
    static VkResult allocate(void* user, const CndMemoryRequest* request, CndMemory* memory);

    PFN_vkGetInstanceProcAddr getInstanceProcAddr_;
    PFN_vkGetDeviceProcAddr getDeviceProcAddr_ = nullptr;
    CndDeviceDesc desc_;
};

} // namespace candelabra::gpu
