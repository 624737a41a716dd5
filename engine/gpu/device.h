// SPDX-License-Identifier: Apache-2.0
// Device: the host's borrowed handles, the engine's Vulkan function table, and the device's limits.
#pragma once

#include <cstdint>
#include <mutex>
#include <string>

#include "gpu/failure.h"
#include "gpu/requirements.h"

namespace candelabra::gpu
{

class Device : public InstanceFunctions
{
public:
    // Throws Failure if the device lacks something that the parts need.
    Device(const CndDeviceDesc& desc, Parts parts);
    Device(const Device&) = delete;
    Device& operator=(const Device&) = delete;

#define X(name) PFN_vk##name name = nullptr;
    CND_DEVICE_FUNCTIONS(X)
    CND_RASTER_FUNCTIONS(X)
    CND_DEBUG_FUNCTIONS(X)
#undef X

    Parts parts; // the parts of the engine that use this device
    VkInstance instance;
    VkPhysicalDevice physicalDevice;
    VkDevice handle;
    VkPipelineCache pipelineCache;
    const VkAllocationCallbacks* allocationCallbacks;
    CndAllocator allocator;     // if allocate is null, the engine allocates device memory itself
    CndMessageCallback message; // may be null
    void* messageUser;
    uint32_t apiVersion = 0; // of Vulkan, that host and physical device both have
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
    mutable std::mutex usageMutex; // objects may be created and destroyed on several threads

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

} // namespace candelabra::gpu
