// SPDX-License-Identifier: Apache-2.0
// The host's message callback receives few messages, each once, and none while recording.
#include <cstring>

#include <gtest/gtest.h>

#include "candelabra/candelabra.hpp"
#include "gpu/failure.h"
#include "harness/host_log.h"
#include "mock/host_steps.h"

namespace candelabra::test
{
namespace
{

std::vector<CndLight> spheres(uint32_t count)
{
    return std::vector<CndLight>(count,
                                 {.type = CND_LIGHT_SPHERE, .radius = 0.1f, .influenceRadius = 5});
}

} // namespace

TEST(Messages, TellOfLateWorkAndNeverWhileRecording)
{
    Host h;
    HostLog log;
    h.device = log.desc(h.device);
    std::map<std::string, size_t> heard; // number of messages by step
    for (const Step& step : steps()) {
        CndError error{};
        ASSERT_EQ(runStep(step, h, &error), CND_SUCCESS) << step.name << ": " << error.message;
        heard[step.name] = log.messages.size();
        EXPECT_TRUE(!step.records || log.messages.empty()) << step.name;
        for (const Message& m : log.messages) {
            EXPECT_EQ(m.severity, CND_MESSAGE_INFO) << m.sentence;
            EXPECT_GT(m.sentence.size(), 20u);
        }
        log.messages.clear();
    }
    EXPECT_EQ(heard["create lighting"], 0u);
    EXPECT_EQ(heard["create view"], 0u);
    // Tubes are a new type, and the capacity is too small; the same holds for discs.
    EXPECT_EQ(heard["set more lights of another type"], 2u);
    EXPECT_EQ(heard["add lights of another type"], 2u);
}

TEST(Messages, NameResultsOfVulkan)
{
    EXPECT_EQ(gpu::resultName(VK_ERROR_DEVICE_LOST), "VK_ERROR_DEVICE_LOST");
    EXPECT_EQ(gpu::resultName(VK_ERROR_OUT_OF_POOL_MEMORY), "VK_ERROR_OUT_OF_POOL_MEMORY");
    for (int error = VK_ERROR_UNKNOWN; error < 0; ++error) // all errors of Vulkan 1.0
        EXPECT_TRUE(gpu::resultName(VkResult(error)).starts_with("VK_ERROR_")) << error;
    EXPECT_EQ(gpu::resultName(VkResult(-5000)), "VkResult -5000");

    MockVulkan vulkan;
    vulkan.failingCall = 1;
    vulkan.error = VK_ERROR_DEVICE_LOST;
    const auto lighting = Lighting::create(vulkan.desc(), {.framesInFlight = 1});
    ASSERT_FALSE(lighting);
    const std::string said = lighting.error().message;
    EXPECT_TRUE(said.ends_with(" failed (VK_ERROR_DEVICE_LOST)")) << said;
}

TEST(Messages, RoomMadeAtCreationIsEnough)
{
    const MockVulkan vulkan;
    HostLog log;
    auto lighting = Lighting::create(log.desc(vulkan.desc()),
                                     {.framesInFlight = 1,
                                      .lightCapacity = 3000,
                                      .lightTypes = 1u << CND_LIGHT_SPHERE | 1u << CND_LIGHT_DISC});
    ASSERT_TRUE(lighting) << lighting.error().message;
    auto view = lighting.value().createView({.maxWidth = 64, .maxHeight = 48});
    ASSERT_TRUE(view) << view.error().message;
    log.expectNone();
    const size_t objects = vulkan.alive.size();
    std::vector<CndLight> lights = spheres(2999);
    lights.push_back(
        {.type = CND_LIGHT_DISC, .radius = 0.1f, .direction = {0, 0, 1}, .influenceRadius = 5});
    ASSERT_TRUE(lighting.value().setLights(lights, {0, 0, 0}));
    log.expectNone();
    EXPECT_EQ(vulkan.alive.size(), objects); // neither new buffers nor new pipelines
    lights.push_back(lights[0]);
    ASSERT_TRUE(lighting.value().setLights(lights, {0, 0, 0}));
    log.expect(CND_MESSAGE_INFO, "from room for 3000 to room for 4500 lights");
    lights[0].type = CND_LIGHT_POINT;
    ASSERT_TRUE(lighting.value().setLights(lights, {0, 0, 0}));
    log.expect(CND_MESSAGE_INFO, "CndLightType 0");
    EXPECT_GT(vulkan.alive.size(), objects);
}

TEST(Messages, TellOfWhatTheDeviceLacks)
{
    MockVulkan vulkan;
    HostLog log;
    CndDeviceDesc device = log.desc(vulkan.desc());
    vulkan.limits.timestampComputeAndGraphics = VK_FALSE;
    ASSERT_TRUE(Exposure::create(device, {.framesInFlight = 1}));
    log.expectNone(); // timestamps were not requested
    ASSERT_TRUE(Exposure::create(device, {.framesInFlight = 1, .timestamps = VK_TRUE}));
    log.expect(CND_MESSAGE_WARNING, "timestamps were asked for");
    vulkan.limits.maxTexelBufferElements = 65536; // the smallest value that Vulkan allows
    ASSERT_TRUE(Lighting::create(device, {.framesInFlight = 1}));
    log.expectNone(); // a GPU reads lights from storage buffers in any case
    vulkan.isLlvmpipe = true;
    ASSERT_TRUE(Lighting::create(device, {.framesInFlight = 1}));
    ASSERT_EQ(log.messages.size(), 2u);
    EXPECT_NE(log.messages[1].sentence.find("maxTexelBufferElements is 65536"), std::string::npos)
        << log.messages[1].sentence;
    log.messages.clear();
    vulkan.limits.maxTexelBufferElements = 1u << 27;
    ASSERT_TRUE(Lighting::create(device, {.framesInFlight = 1}));
    log.expect(CND_MESSAGE_INFO, "ends loops after 65535 iterations: brute force of more than "
                                 "12287 sphere lights, or of fewer lights of other types,");
    vulkan.isLlvmpipe = false;
    device.debugUtilsEnabled = VK_TRUE; // the mock does not have the extension
    ASSERT_TRUE(Lighting::create(device, {.framesInFlight = 1}));
    log.expect(CND_MESSAGE_WARNING, "debugUtilsEnabled");
    device.debugUtilsEnabled = VK_FALSE;
    vulkan.limits.maxStorageBufferRange = 1u << 20;
    auto lighting = Lighting::create(device, {.framesInFlight = 1});
    ASSERT_TRUE(lighting);
    log.expectNone();
    ASSERT_TRUE(lighting.value().createView({.maxWidth = 512, .maxHeight = 512}));
    log.expect(CND_MESSAGE_INFO, "deep tiles");
}

TEST(Messages, AReservationThatCannotBeIsAnError)
{
    const MockVulkan vulkan;
    const auto tooMany =
        Lighting::create(vulkan.desc(), {.framesInFlight = 1, .lightCapacity = 1u << 31});
    EXPECT_EQ(tooMany.error().code, CND_ERROR_UNSUPPORTED);
    EXPECT_NE(std::strstr(tooMany.error().message, "lightCapacity"), nullptr);
    const auto unknown = Lighting::create(
        vulkan.desc(), {.framesInFlight = 1, .lightTypes = 1u << CND_LIGHT_TYPE_COUNT});
    EXPECT_EQ(unknown.error().code, CND_ERROR_INVALID_ARGUMENT);
    EXPECT_NE(std::strstr(unknown.error().message, "lightTypes"), nullptr);
}

} // namespace candelabra::test
