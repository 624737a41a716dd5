// SPDX-License-Identifier: Apache-2.0
// Memory planned before anything is created equals what creation then takes, to the byte.
#include <algorithm>
#include <array>
#include <cstring>
#include <deque>
#include <vector>

#include <gtest/gtest.h>

#include "candelabra/candelabra.hpp"
#include "harness/host_allocator.h"
#include "mock/host_steps.h"

namespace candelabra::test
{
namespace
{

constexpr uint32_t sphere = 1u << CND_LIGHT_SPHERE, tube = 1u << CND_LIGHT_TUBE;

const CndLightingDesc lightingDescs[] = {
    {.framesInFlight = 1},
    {.framesInFlight = 3, .lightCapacity = 5000, .lightTypes = sphere | tube},
    {.framesInFlight = 2,
     .gbufferLayout = CND_GBUFFER_HOST,
     .timestamps = VK_TRUE,
     .gbuffer = {.roughness = CND_CHANNEL_NORMAL_A},
     .forwardStages = VK_SHADER_STAGE_FRAGMENT_BIT,
     .lightCapacity = 10},
    {.framesInFlight = 1, .lightCapacity = 100, .lightTypes = sphere, .influenceByError = VK_TRUE},
    {.framesInFlight = 2, .shadows = {.points = 32}},
    {.framesInFlight = 1,
     .forwardStages = VK_SHADER_STAGE_FRAGMENT_BIT,
     .lightTypes = sphere | 1u << CND_LIGHT_POLYGON,
     .shadows = {.points = 64, .triangleCapacity = 5000, .instanceCapacity = 300}}};

void expectSame(const CndMemoryUsage& planned, const CndMemoryUsage& held)
{
    for (int kind = 0; kind < CND_MEMORY_KIND_COUNT; ++kind) {
        EXPECT_EQ(planned.allocations[kind], held.allocations[kind]) << kind;
        EXPECT_EQ(planned.bytes[kind], held.bytes[kind]) << kind;
        EXPECT_EQ(planned.alignment[kind], held.alignment[kind]) << kind;
        EXPECT_EQ(planned.memoryTypeBits[kind], held.memoryTypeBits[kind]) << kind;
    }
}

// Expects that the module's figures agree with the mock's.
void expectHeld(const MockVulkan& vulkan, const CndMemoryUsage& usage)
{
    VkDeviceSize bytes = 0, held = 0;
    size_t allocations = 0;
    for (int kind = 0; kind < CND_MEMORY_KIND_COUNT; ++kind) {
        bytes += usage.bytes[kind];
        allocations += usage.allocations[kind];
    }
    for (const auto& [handle, memory] : vulkan.memories)
        held += memory.size;
    EXPECT_EQ(bytes, held);
    EXPECT_EQ(allocations, vulkan.memories.size());
}

// Expects that planning has taken no memory, and has created nothing that takes time.
void expectUntouched(const MockVulkan& vulkan)
{
    const std::set<std::string> allowed{"CreateBuffer",
                                        "DestroyBuffer",
                                        "CreateImage",
                                        "DestroyImage",
                                        "GetBufferMemoryRequirements",
                                        "GetImageMemoryRequirements"};
    for (const std::string& name : vulkan.called)
        EXPECT_TRUE(allowed.contains(name)) << name;
    EXPECT_TRUE(vulkan.alive.empty());
}

template <typename Module, typename Desc>
void expectPlanned(const Desc& desc)
{
    const MockVulkan vulkan;
    auto planned = Module::plan(vulkan.desc(), desc);
    ASSERT_TRUE(planned) << planned.error().message;
    expectUntouched(vulkan);
    auto module = Module::create(vulkan.desc(), desc);
    ASSERT_TRUE(module) << module.error().message;
    auto held = module.value().memory();
    ASSERT_TRUE(held) << held.error().message;
    expectSame(planned.value(), held.value());
    expectHeld(vulkan, held.value());
}

} // namespace

TEST(Planning, OfLightingIsWhatCreationTakes)
{
    const std::array<CndLightingViewDesc, 2> views{
        CndLightingViewDesc{.maxWidth = 64, .maxHeight = 48},
        CndLightingViewDesc{.maxWidth = 1920, .maxHeight = 1080, .listBudget = 1 << 20}};
    for (const CndLightingDesc& desc : lightingDescs) {
        MockVulkan vulkan;
        auto planned = Lighting::plan(vulkan.desc(), desc, views);
        ASSERT_TRUE(planned) << planned.error().message;
        std::vector<CndLightingViewDesc> listed(views.begin(), views.end());
        auto again = Lighting::plan(vulkan.desc(), desc, listed);
        ASSERT_TRUE(again) << again.error().message;
        EXPECT_TRUE(std::ranges::equal(again.value().bytes, planned.value().bytes));
        auto alone = Lighting::plan(vulkan.desc(), desc);
        ASSERT_TRUE(alone) << alone.error().message;
        expectUntouched(vulkan);
        auto lighting = Lighting::create(vulkan.desc(), desc);
        ASSERT_TRUE(lighting) << lighting.error().message;
        expectSame(alone.value(), lighting.value().memory().value());
        std::deque<LightingView> made;
        for (const CndLightingViewDesc& view : views)
            made.push_back(std::move(lighting.value().createView(view).value()));
        CndMemoryUsage held = lighting.value().memory().value();
        expectSame(planned.value(), held);
        expectHeld(vulkan, held);
        // A set within the prepared capacity takes nothing more.
        const CndLight light{.type = CND_LIGHT_SPHERE, .radius = 0.1f, .influenceRadius = 5};
        if (desc.lightTypes) {
            const std::vector<CndLight> lights(std::max(desc.lightCapacity, 1u), light);
            ASSERT_TRUE(lighting.value().setLights(lights, {0, 0, 0}));
            expectSame(planned.value(), lighting.value().memory().value());
        }
        const std::vector<CndLight> more(6000, light);
        ASSERT_TRUE(lighting.value().setLights(more, {0, 0, 0}));
        held = lighting.value().memory().value();
        EXPECT_GT(held.bytes[CND_MEMORY_BUFFER], planned.value().bytes[CND_MEMORY_BUFFER]);
        EXPECT_GT(held.bytes[CND_MEMORY_SCRATCH], planned.value().bytes[CND_MEMORY_SCRATCH]);
        expectHeld(vulkan, held);
    }
}

// Occluders within the prepared capacity take nothing more, except for staging buffers.
TEST(Planning, RoomForOccludersIsEnough)
{
    MockVulkan vulkan;
    constexpr uint32_t boxes = 300;
    Lighting lighting = std::move(
        Lighting::create(
            vulkan.desc(),
            {.framesInFlight = 1,
             .shadows = {.points = 64, .triangleCapacity = 1000, .instanceCapacity = boxes}})
            .value());
    LightingView view = std::move(lighting.createView({.maxWidth = 64, .maxHeight = 48}).value());
    const CndMemoryUsage before = lighting.memory().value();
    std::vector<float> positions(9 * 1000);
    for (size_t i = 0; i < positions.size(); ++i)
        positions[i] = float(i * 7919 % 1000);
    const CndOccluderMesh mesh{
        .positions = positions.data(), .vertexCount = 3000, .triangleCount = 1000};
    const CndOccluderInstance instance{.mesh = lighting.addOccluderMesh(mesh).value(),
                                       .worldFromMesh = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}};
    std::vector<CndOccluderId> ids(boxes);
    ASSERT_TRUE(lighting.addOccluders(std::vector(boxes, instance), ids));
    CndMemoryUsage after = lighting.memory().value();
    EXPECT_EQ(after.bytes[CND_MEMORY_BUFFER], before.bytes[CND_MEMORY_BUFFER]);
    EXPECT_EQ(after.bytes[CND_MEMORY_SCRATCH], before.bytes[CND_MEMORY_SCRATCH]);
    ASSERT_TRUE(lighting.addOccluder(instance));
    after = lighting.memory().value();
    EXPECT_GT(after.bytes[CND_MEMORY_SCRATCH], before.bytes[CND_MEMORY_SCRATCH]);
}

TEST(Planning, OfExposureAndEnvironmentIsWhatCreationTakes)
{
    expectPlanned<Exposure>(CndExposureDesc{.framesInFlight = 3, .timestamps = VK_TRUE});
    expectPlanned<Environment>(CndEnvironmentDesc{.framesInFlight = 2, .cubeSize = 512});
    expectPlanned<Environment>(CndEnvironmentDesc{.framesInFlight = 1,
                                                  .gbufferLayout = CND_GBUFFER_HOST,
                                                  .gbuffer = {.roughness = CND_CHANNEL_NORMAL_A}});
}

TEST(Planning, ABlockOfEachKindHoldsEverything)
{
    const std::array<CndLightingViewDesc, 1> views{
        CndLightingViewDesc{.maxWidth = 640, .maxHeight = 360, .listBudget = 1 << 20}};
    for (const CndLightingDesc& desc : lightingDescs) {
        MockVulkan vulkan;
        auto planned = Lighting::plan(vulkan.desc(), desc, views);
        ASSERT_TRUE(planned) << planned.error().message;
        HostAllocator allocator(vulkan.desc(), planned.value());
        auto lighting = Lighting::create(allocator.desc(), desc);
        ASSERT_TRUE(lighting) << lighting.error().message;
        auto view = lighting.value().createView(views[0]);
        ASSERT_TRUE(view) << view.error().message;
        EXPECT_LE(vulkan.memories.size(), size_t(CND_MEMORY_KIND_COUNT));
        EXPECT_TRUE(vulkan.misuse.empty());
        // The blocks hold no more than planned: the next view finds no room.
        EXPECT_EQ(lighting.value().createView(views[0]).error().code, CND_ERROR_OUT_OF_MEMORY);
    }
}

TEST(Planning, FailsLikeCreation)
{
    MockVulkan vulkan;
    const auto expectSameError = [&](const CndDeviceDesc& device, const CndLightingDesc& desc) {
        const auto planned = Lighting::plan(device, desc);
        const auto created = Lighting::create(device, desc);
        EXPECT_NE(created.error().code, CND_SUCCESS);
        EXPECT_EQ(planned.error().code, created.error().code);
        EXPECT_STREQ(planned.error().message, created.error().message);
    };
    expectSameError(vulkan.desc(), {.framesInFlight = 9});
    CndDeviceDesc device = vulkan.desc();
    device.physicalDevice = VK_NULL_HANDLE;
    expectSameError(device, {.framesInFlight = 1});
    device.getInstanceProcAddr = nullptr;
    expectSameError(device, {.framesInFlight = 1});
    device = vulkan.desc();
    device.allocator.free = [](void*, void*) {};
    expectSameError(device, {.framesInFlight = 1});
    device.allocator = {.allocate = [](void*, const CndMemoryRequest*, CndMemory*) {
        return VK_ERROR_OUT_OF_DEVICE_MEMORY;
    }};
    expectSameError(device, {.framesInFlight = 1});
    vulkan.absent = "CmdDispatch";
    expectSameError(vulkan.desc(), {.framesInFlight = 1});
    vulkan.absent = "";
    const auto wide =
        Lighting::plan(vulkan.desc(), {.framesInFlight = 1},
                       std::array{CndLightingViewDesc{.maxWidth = 16385, .maxHeight = 1}});
    EXPECT_NE(std::strstr(wide.error().message, "maxWidth"), nullptr) << wide.error().message;
    CndMemoryUsage usage{.structSize = 8};
    CndError error{};
    device = vulkan.desc();
    const CndExposureDesc desc{.structSize = sizeof desc, .framesInFlight = 1};
    EXPECT_EQ(cndPlanExposure(&device, &desc, &usage, &error), CND_ERROR_INVALID_ARGUMENT);
    EXPECT_NE(std::strstr(error.message, "CndMemoryUsage: structSize is 8"), nullptr);
    expectUntouched(vulkan);
}

} // namespace candelabra::test
