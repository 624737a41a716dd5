// SPDX-License-Identifier: Apache-2.0
// Every Vulkan call that can fail is made to fail, in turn, in a host that creates all modules,
// sets lights twice, records and asks for statistics; then the heap. Each time: a result code, a
// sentence, nothing leaked, and the same step succeeds when it is tried again.
#include <algorithm>
#include <cstring>
#include <functional>
#include <iostream>

#include <gtest/gtest.h>

#include "mock/mock_vulkan.h"

namespace candelabra::test
{
namespace
{

constexpr uint32_t firstCount = 3, secondCount = 3000; // the second set needs larger buffers

struct Host {
    MockVulkan vulkan;
    CndLighting lighting = nullptr;
    CndLightingView view = nullptr;
    CndExposure exposure = nullptr;
    CndEnvironment environment = nullptr;
    uint32_t lightCount = 0; // of the set that succeeded last
    CndLightId added[2] = {};

    ~Host() { destroy(); }
    void destroy()
    {
        cndDestroyLightingView(view);
        cndDestroyLighting(lighting);
        cndDestroyExposure(exposure);
        cndDestroyEnvironment(environment);
        view = nullptr;
        lighting = nullptr;
        exposure = nullptr;
        environment = nullptr;
    }
};

CndResult setLights(Host& h, CndLightType type, uint32_t count, CndError* error)
{
    CndLight light{.type = uint32_t(type), .radius = 0.1f, .influenceRadius = 5};
    light.axisU[0] = 0.5f;
    std::vector<CndLight> lights;
    {
        const HostAllocations::Pause host;
        lights.assign(count, light);
    }
    const CndLightSet set{.structSize = sizeof set, .count = count, .lights = lights.data()};
    const CndResult result = cndSetLights(h.lighting, &set, error);
    if (result == CND_SUCCESS)
        h.lightCount = count;
    const HostAllocations::Pause host;
    lights = {};
    return result;
}

CndCamera camera()
{
    CndCamera c{};
    for (int i = 0; i < 4; ++i)
        c.viewFromWorld[5 * i] = 1;
    c.clipFromView[0] = 1;
    c.clipFromView[5] = -1;
    c.clipFromView[11] = -1;
    c.clipFromView[14] = 0.1f;
    return c;
}

template <typename Frame>
Frame surfaces()
{
    const VkImageView any = MockVulkan::imageView();
    return {.structSize = sizeof(Frame),
            .width = 64,
            .height = 48,
            .camera = camera(),
            .normalRoughness = any,
            .albedo = any,
            .specular = any,
            .depth = any,
            .radiance = any};
}

CndResult recordTubes(Host& h, CndError* error)
{
    CndLightingFrame frame = surfaces<CndLightingFrame>();
    frame.frameSlot = 1;
    frame.specularMethod = CND_SPECULAR_CONIC;
    return cndRecordLighting(h.view, MockVulkan::commandBuffer(), &frame, error);
}

struct Step {
    const char* name;
    bool records; // may allocate nothing, and call only what records
    std::function<CndResult(Host&, CndError*)> run;
};

const std::vector<Step>& steps()
{
    static const std::vector<Step> all = {
        {"create lighting", false,
         [](Host& h, CndError* error) {
             const CndDeviceDesc device = h.vulkan.desc();
             const CndLightingDesc desc{.structSize = sizeof desc,
                                        .framesInFlight = 2,
                                        .gbufferLayout = CND_GBUFFER_HOST,
                                        .timestamps = true,
                                        .gbuffer = {.roughness = CND_CHANNEL_NORMAL_A},
                                        .forwardStages = VK_SHADER_STAGE_FRAGMENT_BIT};
             return cndCreateLighting(&device, &desc, &h.lighting, error);
         }},
        {"create view", false,
         [](Host& h, CndError* error) {
             const CndLightingViewDesc desc{
                 .structSize = sizeof desc, .maxWidth = 64, .maxHeight = 48};
             return cndCreateLightingView(h.lighting, &desc, &h.view, error);
         }},
        {"create exposure", false,
         [](Host& h, CndError* error) {
             const CndDeviceDesc device = h.vulkan.desc();
             const CndExposureDesc desc{
                 .structSize = sizeof desc, .framesInFlight = 2, .timestamps = true};
             return cndCreateExposure(&device, &desc, &h.exposure, error);
         }},
        {"create environment", false,
         [](Host& h, CndError* error) {
             const CndDeviceDesc device = h.vulkan.desc();
             const CndEnvironmentDesc desc{.structSize = sizeof desc,
                                           .framesInFlight = 2,
                                           .gbufferLayout = CND_GBUFFER_HOST,
                                           .timestamps = true,
                                           .gbuffer = {.roughness = CND_CHANNEL_NORMAL_A}};
             return cndCreateEnvironment(&device, &desc, &h.environment, error);
         }},
        {"set lights", false,
         [](Host& h, CndError* error) {
             return setLights(h, CND_LIGHT_SPHERE, firstCount, error);
         }},
        {"record", true,
         [](Host& h, CndError* error) {
             CndLightingFrame frame = surfaces<CndLightingFrame>();
             frame.specularMethod = CND_SPECULAR_CONIC;
             frame.countPairs = VK_TRUE;
             return cndRecordLighting(h.view, MockVulkan::commandBuffer(), &frame, error);
         }},
        {"record overlay", true,
         [](Host& h, CndError* error) {
             const CndLightingFrame frame = surfaces<CndLightingFrame>();
             const CndSurfaceOverlay overlay{.structSize = sizeof overlay,
                                             .image = MockVulkan::imageView()};
             return cndRecordSurfaceOverlay(h.view, MockVulkan::commandBuffer(), &frame, &overlay,
                                            error);
         }},
        {"set more lights of another type", false,
         [](Host& h, CndError* error) { return setLights(h, CND_LIGHT_TUBE, secondCount, error); }},
        {"record the other lights", true, recordTubes},
        {"update lights", false,
         [](Host& h, CndError* error) {
             const CndLight light{.type = CND_LIGHT_TUBE,
                                  .radius = 0.2f,
                                  .influenceRadius = 6,
                                  .axisU = {0.5f, 0, 0}};
             const CndLightId id = secondCount / 2;
             return cndUpdateLights(h.lighting, 1, &id, &light, error);
         }},
        {"record the updated lights", true, recordTubes},
        {"add lights of another type", false, // to full buffers
         [](Host& h, CndError* error) {
             const CndLight light{.type = CND_LIGHT_DISC,
                                  .radius = 0.1f,
                                  .direction = {0, 0, 1},
                                  .influenceRadius = 5};
             const CndLight lights[] = {light, light};
             const CndResult result = cndAddLights(h.lighting, 2, lights, h.added, error);
             if (result == CND_SUCCESS)
                 h.lightCount += 2;
             return result;
         }},
        {"record the added lights", true, recordTubes},
        {"remove lights", false,
         [](Host& h, CndError* error) {
             const CndLightId ids[] = {0, h.added[0], secondCount / 2};
             const CndResult result = cndRemoveLights(h.lighting, 3, ids, error);
             if (result == CND_SUCCESS)
                 h.lightCount -= 3;
             return result;
         }},
        {"record what is left", true, recordTubes},
        {"record exposure", true,
         [](Host& h, CndError* error) {
             CndExposureFrame frame{.structSize = sizeof frame,
                                    .width = 64,
                                    .height = 48,
                                    .radiance = MockVulkan::imageView(),
                                    .display = MockVulkan::imageView()};
             cndDefaultExposureSettings(&frame.settings);
             return cndRecordExposure(h.exposure, MockVulkan::commandBuffer(), &frame, error);
         }},
        {"record environment map", true,
         [](Host& h, CndError* error) {
             const CndEnvironmentMap map{.structSize = sizeof map,
                                         .width = 32,
                                         .height = 16,
                                         .equirectangular = MockVulkan::imageView()};
             return cndRecordEnvironmentMap(h.environment, MockVulkan::commandBuffer(), &map,
                                            error);
         }},
        {"record environment", true,
         [](Host& h, CndError* error) {
             CndEnvironmentFrame frame = surfaces<CndEnvironmentFrame>();
             for (int i = 0; i < 3; ++i)
                 frame.worldFromEnvironment[4 * i] = 1;
             frame.scale = 1;
             return cndRecordEnvironment(h.environment, MockVulkan::commandBuffer(), &frame, error);
         }},
        {"lighting statistics", false,
         [](Host& h, CndError*) {
             CndLightingStats stats{.structSize = sizeof stats};
             return cndGetLightingStats(h.view, 1, &stats);
         }},
        {"exposure statistics", false,
         [](Host& h, CndError*) {
             CndExposureStats stats{.structSize = sizeof stats};
             return cndGetExposureStats(h.exposure, 0, &stats);
         }},
        {"environment statistics", false,
         [](Host& h, CndError*) {
             CndEnvironmentStats stats{.structSize = sizeof stats};
             return cndGetEnvironmentStats(h.environment, 0, &stats);
         }},
    };
    return all;
}

bool reportsSentence(const std::string& step)
{
    return step.find("statistics") == std::string::npos;
}

// A step, and on a device that is infinitely fast what it recorded.
CndResult runStep(const Step& step, Host& h, CndError* error)
{
    const CndResult result = step.run(h, error);
    const HostAllocations::Pause host;
    if (step.records && result == CND_SUCCESS)
        h.vulkan.finish(h.vulkan.submit());
    return result;
}

CndResult recordAgain(Host& h, CndError* error)
{
    const auto record = std::find_if(steps().begin(), steps().end(), [](const Step& step) {
        return std::strcmp(step.name, "record") == 0;
    });
    return runStep(*record, h, error);
}

// Runs all steps; the failing call is set by the caller. Returns the step that failed.
std::string runSteps(Host& h, CndResult expected, VkResult expectedVulkan)
{
    std::string failedStep;
    for (const Step& step : steps()) {
        CndError error{};
        const uint32_t lightsBefore = h.lightCount;
        CndResult result = runStep(step, h, &error);
        if (h.vulkan.failed.empty() || !failedStep.empty()) {
            EXPECT_EQ(result, CND_SUCCESS) << step.name << ": " << error.message;
            continue;
        }
        failedStep = step.name;
        EXPECT_EQ(result, expected) << step.name << ", " << h.vulkan.failed;
        if (reportsSentence(step.name)) {
            EXPECT_EQ(error.vkResult, expectedVulkan) << step.name << ", " << h.vulkan.failed;
            EXPECT_GT(std::strlen(error.message), 10u) << step.name << ", " << h.vulkan.failed;
        }
        // The set of lights before it still stands, and can be recorded.
        if (h.view && lightsBefore) {
            EXPECT_EQ(recordAgain(h, &error), CND_SUCCESS) << error.message;
            CndLightingStats stats{.structSize = sizeof stats};
            EXPECT_EQ(cndGetLightingStats(h.view, 0, &stats), CND_SUCCESS);
            EXPECT_EQ(stats.lightCount, h.lightCount);
        }
        result = runStep(step, h, &error);
        EXPECT_EQ(result, CND_SUCCESS) << "again: " << step.name << ": " << error.message;
    }
    return failedStep;
}

void expectClean(Host& h, const std::string& where)
{
    h.destroy();
    for (const auto& [handle, kind] : h.vulkan.alive)
        ADD_FAILURE() << kind << " " << handle << " leaked, " << where;
    for (const std::string& what : h.vulkan.misuse)
        ADD_FAILURE() << what << ", " << where;
}

} // namespace

TEST(Faults, EveryVulkanCallFailsInTurn)
{
    uint64_t calls = 0;
    {
        Host h;
        EXPECT_EQ(runSteps(h, CND_SUCCESS, VK_SUCCESS), "");
        calls = h.vulkan.failableCalls;
        expectClean(h, "without faults");
    }
    ASSERT_GT(calls, 100u);
    std::cout << calls << " calls that can fail\n";
    std::map<std::string, int> failures; // by step
    std::set<std::string> functions;
    for (uint64_t call = 0; call < calls && !HasFailure(); ++call)
        for (const VkResult error :
             {VK_ERROR_OUT_OF_HOST_MEMORY, VK_ERROR_OUT_OF_DEVICE_MEMORY, VK_ERROR_DEVICE_LOST}) {
            Host h;
            h.vulkan.failingCall = call;
            h.vulkan.error = error;
            const CndResult expected =
                error == VK_ERROR_DEVICE_LOST ? CND_ERROR_DEVICE : CND_ERROR_OUT_OF_MEMORY;
            ++failures[runSteps(h, expected, error)];
            functions.insert(h.vulkan.failed);
            expectClean(h, h.vulkan.failed + " failing, call " + std::to_string(call));
        }
    for (const char* name :
         {"create lighting", "create view", "create exposure", "create environment", "set lights",
          "set more lights of another type", "add lights of another type", "lighting statistics",
          "exposure statistics", "environment statistics"})
        EXPECT_GT(failures[name], 0) << name;
    for (const char* name :
         {"CreateBuffer", "AllocateMemory", "BindBufferMemory", "MapMemory", "CreateBufferView",
          "CreateShaderModule", "CreateComputePipelines", "CreatePipelineLayout",
          "CreateDescriptorSetLayout", "CreateDescriptorPool", "AllocateDescriptorSets",
          "CreateQueryPool", "CreateImage", "CreateImageView", "BindImageMemory", "CreateSampler",
          "GetQueryPoolResults"})
        EXPECT_TRUE(functions.contains(name)) << name << " never failed";
}

TEST(Faults, TheHeapFailsInTurn)
{
    uint64_t total = 0;
    for (int i = 0; i < 2; ++i) { // the first time also makes what lasts as long as the program
        Host h;
        const HostAllocations allocations;
        for (const Step& step : steps())
            runStep(step, h, nullptr);
        total = allocations.count();
    }
    ASSERT_GT(total, 1000u);
    std::cout << total << " allocations\n";
    // The first ones one by one, then ever more apart: most are alike, of reading SPIR-V.
    for (uint64_t failing = 0; failing < total && !HasFailure(); failing += 1 + failing / 100) {
        Host h;
        int failures = 0;
        {
            const HostAllocations allocations(failing);
            for (const Step& step : steps()) {
                CndError error{};
                CndResult result = runStep(step, h, &error);
                if (result == CND_SUCCESS)
                    continue;
                ++failures;
                EXPECT_EQ(result, CND_ERROR_OUT_OF_MEMORY) << step.name << ": " << error.message;
                result = runStep(step, h, &error);
                EXPECT_EQ(result, CND_SUCCESS) << "again: " << step.name << ": " << error.message;
            }
        }
        EXPECT_EQ(failures, 1) << "allocation " << failing;
        expectClean(h, "allocation " + std::to_string(failing));
    }
}

// Also that nothing is looked up that submits, waits or takes a queue.
TEST(Faults, RecordingOnlyRecords)
{
    Host h;
    for (const Step& step : steps()) {
        h.vulkan.called.clear();
        CndError error{};
        uint64_t allocated = 0;
        CndResult result = CND_SUCCESS;
        {
            const HostAllocations allocations;
            result = runStep(step, h, &error);
            allocated = allocations.count();
        }
        ASSERT_EQ(result, CND_SUCCESS) << error.message;
        if (!step.records)
            continue;
        EXPECT_EQ(allocated, 0u) << step.name;
        EXPECT_TRUE(h.vulkan.called.contains("CmdDispatch")) << step.name;
        for (const std::string& name : h.vulkan.called)
            EXPECT_TRUE(name.starts_with("Cmd") || name == "UpdateDescriptorSets") << name;
    }
    for (const std::string& name : h.vulkan.lookedUp)
        for (const char* never : {"Queue", "Wait", "Fence", "Semaphore", "Event"})
            EXPECT_TRUE(name == "CreateQueryPool" || name.find(never) == std::string::npos) << name;
    EXPECT_GT(h.vulkan.lookedUp.size(), 20u);
}

TEST(Faults, MissingFunctionsAreNamed)
{
    std::set<std::string> functions;
    {
        Host h;
        ASSERT_EQ(steps()[0].run(h, nullptr), CND_SUCCESS);
        functions = h.vulkan.lookedUp;
    }
    for (const std::string& name : functions) {
        Host h;
        h.vulkan.absent = name;
        CndError error{};
        EXPECT_EQ(steps()[0].run(h, &error), CND_ERROR_UNSUPPORTED) << name;
        EXPECT_NE(std::string(error.message).find("vk" + name), std::string::npos) << error.message;
        EXPECT_EQ(h.lighting, nullptr);
    }
}

TEST(Faults, CreatedAThousandTimesNothingGrows)
{
    Host h;
    for (int i = 0; i < 1000 && !HasFailure(); ++i) {
        for (const Step& step : steps()) {
            CndError error{};
            ASSERT_EQ(runStep(step, h, &error), CND_SUCCESS) << step.name << ": " << error.message;
        }
        expectClean(h, "round " + std::to_string(i));
    }
    EXPECT_TRUE(h.vulkan.memories.empty());
    EXPECT_TRUE(h.vulkan.buffers.empty());
}

} // namespace candelabra::test
