// SPDX-License-Identifier: Apache-2.0
// Device: the host's borrowed handles, our function table, and the limits we plan with.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "gpu/failure.h"
#include "gpu/functions.h"

namespace candelabra::gpu
{

// Storage buffers of a kernel, at most: cluster_lists. The descriptor set of a host comes on top.
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
    CndAllocator allocator;     // allocate is null: memory is ours
    CndMessageCallback message; // may be null
    void* messageUser;
    VkPhysicalDeviceLimits limits{};
    // Loop iterations that one shader invocation may do, all its loops together. llvmpipe ends
    // loops silently after 65535 (LP_MAX_TGSI_LOOP_ITERATIONS in Mesa's gallivm); no limit
    // elsewhere.
    uint32_t maxLoopIterations = UINT32_MAX;
    VkPhysicalDeviceMemoryProperties memory{};
    // Of all objects that live on this device: they keep it (gpu/memory.h).
    mutable CndMemoryUsage usage{};

    // Throws Failure when `out` is another version's.
    void readUsage(CndMemoryUsage& out) const;

    // Debug-utils name; nothing when the extension is off.
    void name(VkObjectType type, uint64_t object, const std::string& text) const;
    template <typename H>
    void name(VkObjectType type, H object, const std::string& text) const
    {
        name(type, reinterpret_cast<uint64_t>(object), text);
    }
    // A sentence for the host's log, as of printf.
    [[gnu::format(printf, 3, 4)]] void say(CndMessageSeverity severity, const char* format,
                                           ...) const noexcept;
    void beginLabel(VkCommandBuffer cmd, const char* text) const;
    void endLabel(VkCommandBuffer cmd) const;

    // Index of a memory type allowed by `typeBits` with all of `required` and, if there is one, all
    // of `preferred`. Throws Failure when there is none.
    uint32_t memoryType(uint32_t typeBits, VkMemoryPropertyFlags required,
                        VkMemoryPropertyFlags preferred) const;
};

// What the engine needs and the device lacks, in words; empty when it lacks nothing.
std::vector<std::string> missingFeatures(VkInstance instance, VkPhysicalDevice physicalDevice,
                                         PFN_vkGetInstanceProcAddr getInstanceProcAddr);

// Sets every feature the engine needs.
void requireFeatures(VkPhysicalDeviceFeatures& core10, VkPhysicalDeviceVulkan12Features& core12,
                     VkPhysicalDeviceVulkan13Features& core13);

} // namespace candelabra::gpu
