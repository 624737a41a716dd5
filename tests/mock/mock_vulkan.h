// SPDX-License-Identifier: Apache-2.0
// A mock Vulkan driver that keeps track of objects and computes nothing: it hands out handles,
// remembers which are alive, and fails calls on request. The engine calls only what the host's
// vkGetInstanceProcAddr returns, so this is all of Vulkan that it sees. Only one mock may exist at
// a time, because Vulkan's function pointers carry no context.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "candelabra/candelabra.h"
#include "mock/host_allocations.h"

namespace candelabra::test
{

class MockVulkan
{
public:
    MockVulkan();
    ~MockVulkan();
    MockVulkan(const MockVulkan&) = delete;
    MockVulkan& operator=(const MockVulkan&) = delete;

    static const MockVulkan& current();
    // Contains allocation callbacks, which the engine must pass to every call that takes some.
    CndDeviceDesc desc() const;
    static VkCommandBuffer commandBuffer();
    // Stand-ins for images and buffers of the host, which the mock does not track.
    static VkImageView imageView();
    static VkBuffer hostBuffer();
    // At the origin, with reversed depth.
    static CndCamera camera();

    // Names of the calls since construction that return a VkResult.
    std::vector<const char*> failableCalls;
    // The index of the call that fails (from 0) and its result. `failed` receives its name.
    uint64_t failingCall = UINT64_MAX;
    VkResult error = VK_ERROR_OUT_OF_HOST_MEMORY;
    std::string failed;
    // Name of a device function that is reported as missing.
    std::string absent;
    VkPhysicalDeviceLimits limits; // generous values
    bool isLlvmpipe = false;
    uint32_t apiVersion = VK_API_VERSION_1_3; // of the physical device
    // The instance was created for Vulkan 1.0: queries with a chain fill in nothing of it.
    bool ignoresChains = false;
    std::set<std::string> extensions; // of the physical device
    std::string lackingFeature;       // the physical device has all features but this one
    VkSubgroupFeatureFlags subgroupOperations = ~0u;
    VkMemoryPropertyFlags lackingMemory = 0; // no memory has these properties
    VkFormatFeatureFlags lackingFormatFeatures = 0;

    // submit() puts everything recorded since the last submission in flight; finish() completes it.
    // Fills are executed at completion, all other commands never.
    uint64_t submit();
    void finish(uint64_t submission);

    // Receives the code of every shader module, if it is not null.
    std::vector<std::vector<uint32_t>>* shaders = nullptr;

    // Names of all device functions called since the set was last cleared, and of all looked up.
    std::set<std::string> called, lookedUp;
    // Handles that were created and not destroyed, with their kind.
    std::map<uint64_t, std::string> alive;
    // Uses of the API that a real driver would have punished with a crash or wrong results.
    std::vector<std::string> misuse;

    struct Memory {
        VkDeviceSize size = 0;
        std::unique_ptr<std::byte[]> bytes; // allocated when mapped
    };
    std::map<VkDeviceMemory, Memory> memories;
    struct Buffer {
        VkDeviceSize size = 0;
        VkDeviceMemory memory = VK_NULL_HANDLE;
        VkDeviceSize offset = 0; // in `memory`
    };
    std::map<VkBuffer, Buffer> buffers;

    // The objects that a command buffer uses, and those that it will change.
    struct Commands {
        std::set<uint64_t> used; // handles of objects
        struct Fill {
            VkBuffer buffer;
            VkDeviceSize offset, size;
            uint32_t data;
        };
        std::vector<Fill> fills;
        struct Read { // mapped memory that the GPU reads, and that must not change until then
            VkBuffer buffer;
            VkDeviceSize offset;
            std::vector<std::byte> bytes;
        };
        std::vector<Read> reads;
    };
    Commands recorded;
    std::map<uint64_t, Commands> inFlight;
    struct DescriptorSet {
        VkDescriptorPool pool = VK_NULL_HANDLE;
        std::map<uint32_t, uint64_t> resources; // by binding: handles of buffers and texel views
    };
    std::map<VkDescriptorSet, DescriptorSet> sets;
};

} // namespace candelabra::test
