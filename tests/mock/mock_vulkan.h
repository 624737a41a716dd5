// SPDX-License-Identifier: Apache-2.0
// A Vulkan driver that keeps books and computes nothing: hands out handles, remembers which live,
// fails when told to. The engine calls nothing but what the host's vkGetInstanceProcAddr returns,
// so this is all of Vulkan that it sees. One at a time: Vulkan's function pointers carry no
// context.
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
    // With allocation callbacks, which every call must be given back.
    CndDeviceDesc desc() const;
    static VkCommandBuffer commandBuffer();
    // For images and buffers of the host, which the mock knows nothing of.
    static VkImageView imageView();
    static VkBuffer hostBuffer();

    // Calls that return a VkResult, since the construction.
    uint64_t failableCalls = 0;
    // That one of them that fails, from 0, how, and, when it was called, its name.
    uint64_t failingCall = UINT64_MAX;
    VkResult error = VK_ERROR_OUT_OF_HOST_MEMORY;
    std::string failed;
    // A device function by this name is not there.
    std::string absent;
    VkPhysicalDeviceLimits limits; // ample
    VkDriverId driver = VkDriverId(0);

    // What was recorded since the last submission, which is then in flight until it finishes.
    // Fills happen when it finishes; what else is recorded never does.
    uint64_t submit();
    void finish(uint64_t submission);

    // Every device function called since it was last cleared, and every one asked for.
    std::set<std::string> called, lookedUp;
    // Handles that were created and not destroyed, with their kind.
    std::map<uint64_t, std::string> alive;
    // What a driver would have crashed on, or shown wrong.
    std::vector<std::string> misuse;

    struct Memory {
        VkDeviceSize size = 0;
        std::unique_ptr<std::byte[]> bytes; // when mapped
    };
    std::map<VkDeviceMemory, Memory> memories;
    struct Buffer {
        VkDeviceSize size = 0;
        VkDeviceMemory memory = VK_NULL_HANDLE;
        VkDeviceSize offset = 0; // in it
    };
    std::map<VkBuffer, Buffer> buffers;

    // Of a command buffer: what it uses, and what it leaves behind.
    struct Commands {
        std::set<uint64_t> used; // handles
        struct Fill {
            VkBuffer buffer;
            VkDeviceSize offset, size;
            uint32_t data;
        };
        std::vector<Fill> fills;
        struct Read { // of mapped memory, which must stay as it was
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
        std::map<uint32_t, uint64_t> resources; // by binding: buffers and texel views
    };
    std::map<VkDescriptorSet, DescriptorSet> sets;
};

} // namespace candelabra::test
