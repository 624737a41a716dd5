// SPDX-License-Identifier: Apache-2.0
// Tests that all device memory comes from the host's allocator and is given back, and tests every
// way in which the allocator can fail.
#include <cstring>

#include <gtest/gtest.h>

#include "harness/host_allocator.h"
#include "mock/host_steps.h"

namespace candelabra::test
{
namespace
{

constexpr VkDeviceSize blockBytes = 1 << 20;

// A host with an allocator, which is destroyed last.
struct AllocatingHost {
    Host host;
    HostAllocator allocator{host.vulkan.desc(), blockBytes};

    AllocatingHost() { host.device = allocator.desc(); }
    ~AllocatingHost() { host.destroy(); }
    // Expects that all memory has been given back.
    void expectBalance(const std::string& where)
    {
        host.destroy();
        for (const auto& [number, placed] : allocator.live)
            ADD_FAILURE() << placed.name << " was not freed, " << where;
        EXPECT_EQ(allocator.unknownFrees, 0u) << where;
        for (const auto& [handle, kind] : host.vulkan.alive)
            EXPECT_TRUE(host.vulkan.memories.contains(VkDeviceMemory(handle))) << kind << where;
        for (const std::string& what : host.vulkan.misuse)
            ADD_FAILURE() << what << ", " << where;
    }
};

std::string createWith(const CndDeviceDesc& device, CndResult expected)
{
    const CndLightingDesc desc{.structSize = sizeof desc, .framesInFlight = 1};
    CndLighting lighting = nullptr;
    CndError error{};
    EXPECT_EQ(cndCreateLighting(&device, &desc, &lighting, &error), expected) << error.message;
    cndDestroyLighting(lighting);
    return error.message;
}

} // namespace

TEST(Allocator, TakesEverything)
{
    AllocatingHost h;
    std::set<CndMemoryKind> kinds;
    h.allocator.refuse = [&](const CndMemoryRequest& request) {
        kinds.insert(request.kind);
        EXPECT_GT(std::strlen(request.name), 0u);
        EXPECT_GT(request.requirements.size, 0u);
        const bool image = request.kind == CND_MEMORY_IMAGE;
        EXPECT_EQ(request.image != VK_NULL_HANDLE, image) << request.name;
        EXPECT_EQ(request.buffer != VK_NULL_HANDLE, !image) << request.name;
        return VK_SUCCESS;
    };
    for (const Step& step : steps()) {
        const uint64_t before = h.allocator.allocations;
        CndError error{};
        ASSERT_EQ(runStep(step, h.host, &error), CND_SUCCESS) << step.name << error.message;
        EXPECT_TRUE(!step.records || h.allocator.allocations == before) << step.name;
    }
    EXPECT_EQ(kinds.size(), size_t(CND_MEMORY_KIND_COUNT));
    EXPECT_GT(h.allocator.live.size(), 40u);
    // The host's blocks are the only memory allocations.
    EXPECT_LT(h.host.vulkan.memories.size(), 70u);
    h.expectBalance("at the end");
}

TEST(Allocator, EveryCallFailsInTurn)
{
    uint64_t calls = 0;
    {
        AllocatingHost h;
        EXPECT_EQ(runSteps(steps(), h.host, CND_SUCCESS, VK_SUCCESS), "");
        calls = h.allocator.allocations;
        h.expectBalance("without faults");
    }
    ASSERT_GT(calls, 40u);
    for (uint64_t call = 0; call < calls && !::testing::Test::HasFailure(); ++call) {
        AllocatingHost h;
        h.allocator.refuse = [&](const CndMemoryRequest& request) {
            if (h.allocator.allocations != call + 1)
                return VK_SUCCESS;
            h.host.vulkan.failed = request.name;
            return VK_ERROR_OUT_OF_DEVICE_MEMORY;
        };
        EXPECT_NE(runSteps(steps(), h.host, CND_ERROR_OUT_OF_MEMORY, VK_ERROR_OUT_OF_DEVICE_MEMORY),
                  "");
        h.expectBalance("call " + std::to_string(call));
    }
}

TEST(Allocator, ItsFaultsAreNamed)
{
    AllocatingHost h;
    h.allocator.refuse = [](const CndMemoryRequest&) { return VK_ERROR_OUT_OF_DEVICE_MEMORY; };
    EXPECT_NE(createWith(h.host.device, CND_ERROR_OUT_OF_MEMORY).find("allocate failed for"),
              std::string::npos);
    h.allocator.refuse = [](const CndMemoryRequest&) { return VK_INCOMPLETE; };
    createWith(h.host.device, CND_ERROR_OUT_OF_MEMORY);
    h.allocator.refuse = [](const CndMemoryRequest&) { return VK_SUCCESS; };
    struct Fault {
        void (*make)(CndMemory&);
        const char* says;
    };
    const Fault faults[] = {
        {[](CndMemory& m) { m.memory = VK_NULL_HANDLE; }, "gave no memory for"},
        {[](CndMemory& m) { m.offset += 1; }, "no multiple of the alignment"},
        {[](CndMemory& m) { m.mapped = nullptr; }, "gave memory that is not mapped for"}};
    for (const Fault& fault : faults) {
        h.allocator.spoil = fault.make;
        const std::string sentence = createWith(h.host.device, CND_ERROR_INVALID_ARGUMENT);
        EXPECT_NE(sentence.find(fault.says), std::string::npos) << sentence;
        h.expectBalance(fault.says);
    }
    CndDeviceDesc half = h.host.device;
    half.allocator.free = nullptr;
    EXPECT_EQ(createWith(half, CND_ERROR_INVALID_ARGUMENT),
              "CndDeviceDesc: allocator has only one of allocate and free");
}

TEST(Allocator, AnotherSizeOfTheDescriptorIsRefused)
{
    const MockVulkan vulkan;
    CndDeviceDesc device = vulkan.desc();
    device.structSize -= 8;
    EXPECT_NE(createWith(device, CND_ERROR_INVALID_ARGUMENT).find("CndDeviceDesc: structSize is "),
              std::string::npos);
}

} // namespace candelabra::test
