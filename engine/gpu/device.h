// SPDX-License-Identifier: Apache-2.0
// Device: the host's borrowed handles, the engine's Vulkan function table, and the device's limits.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "gpu/failure.h"
#include "gpu/functions.h"

namespace candelabra::gpu
{

// The most storage buffers that a kernel has (cluster_lists). A host's descriptor set adds its own.
constexpr uint32_t maxStorageBuffers = 10;

class Device
{
public:
    explicit Device(const CndDeviceDesc& desc);
    Device(const Device&) = delete;
    Device& operator=(const Device&) = delete;

#define X(name) PFN_vk##name name = nullptr;
    CND_INSTANCE_FUNCTIONS(X)
    CND_DEVICE_FUNCTIONS(X)
    CND_DEBUG_FUNCTIONS(X)
#undef X

    VkInstance instance;
    VkPhysicalDevice physicalDevice;
    VkDevice handle;
    VkPipelineCache pipelineCache;
    const VkAllocationCallbacks* allocationCallbacks;
    CndAllocator allocator;     // if allocate is null, the engine allocates device memory itself
    CndMessageCallback message; // may be null
    void* messageUser;
    VkPhysicalDeviceLimits limits{};
    // The device is llvmpipe, which runs the lanes of a subgroup as one vector of a CPU. Some costs
    // are then the reverse of a GPU's. Storage reads, shared memory, atomics and subgroup
    // operations cost every lane, texel reads cost a fifth of storage reads, and a long serial loop
    // in each lane is cheaper than lanes that share its work. Kernels that have a form for each
    // kind of device choose by this.
    bool lanesAreCpuVector = false;
    // Loop iterations that one shader invocation may execute, over all its loops. llvmpipe ends
    // loops silently after 65535 (LP_MAX_TGSI_LOOP_ITERATIONS in Mesa's gallivm); other devices
    // have no limit.
    uint32_t maxLoopIterations = UINT32_MAX;
    VkPhysicalDeviceMemoryProperties memory{};
    // Memory of all objects that exist on this device, kept up to date by gpu/memory.h.
    mutable CndMemoryUsage usage{};

    // Copies `usage` to `out`. Throws Failure if out.structSize is that of another version.
    void readUsage(CndMemoryUsage& out) const;

    // Gives an object a debug-utils name; does nothing when the extension is off.
    void name(VkObjectType type, uint64_t object, const std::string& text) const;
    template <typename H>
    void name(VkObjectType type, H object, const std::string& text) const
    {
        name(type, reinterpret_cast<uint64_t>(object), text);
    }
    // Sends a sentence to the host's message callback, formatted as by printf.
    [[gnu::format(printf, 3, 4)]] void say(CndMessageSeverity severity, const char* format,
                                           ...) const noexcept;
    void beginLabel(VkCommandBuffer cmd, const char* text) const;
    void endLabel(VkCommandBuffer cmd) const;

    // Returns the index of a memory type in `typeBits` that has all of `required` and, if possible,
    // all of `preferred`. Throws Failure when there is none.
    uint32_t memoryType(uint32_t typeBits, VkMemoryPropertyFlags required,
                        VkMemoryPropertyFlags preferred) const;
};

// Returns in words what the engine needs and the device lacks; empty when nothing is missing.
std::vector<std::string> missingFeatures(VkInstance instance, VkPhysicalDevice physicalDevice,
                                         PFN_vkGetInstanceProcAddr getInstanceProcAddr);

// Sets every feature that the engine needs to VK_TRUE.
void requireFeatures(VkPhysicalDeviceFeatures& core10, VkPhysicalDeviceVulkan12Features& core12,
                     VkPhysicalDeviceVulkan13Features& core13);

} // namespace candelabra::gpu
