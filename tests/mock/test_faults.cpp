// SPDX-License-Identifier: Apache-2.0
// Makes every Vulkan call that can fail do so, one by one, in a host that creates all modules, sets
// lights of several kinds, records and asks for statistics, in a host that draws with the raster
// pass, and in one with shadows. Then does the same with heap allocations. Each time the step must
// return a result code and a sentence, leak nothing, and succeed when it is run again.
#include <array>
#include <iostream>

#include <gtest/gtest.h>

#include "harness/full_tests.h"
#include "mock/host_steps.h"

namespace candelabra::test
{
namespace
{

struct Family {
    const char* name;
    const std::vector<Step>& (*steps)();
    uint64_t calls, allocations;      // the steps make more than so many
    std::vector<const char*> failing; // names of steps that can fail
    std::vector<const char*> functions;
};

const Family families[] = {
    {"Modules",
     steps,
     100,
     1000,
     {"create lighting", "create view", "create exposure", "create environment", "set lights",
      "set more lights of another type", "add lights of another type", "set lights of the device",
      "add lights beside those of the device", "lighting statistics", "exposure statistics",
      "environment statistics"},
     {"CreateBuffer", "AllocateMemory", "BindBufferMemory", "MapMemory", "CreateBufferView",
      "CreateShaderModule", "CreateComputePipelines", "CreatePipelineLayout",
      "CreateDescriptorSetLayout", "CreateDescriptorPool", "AllocateDescriptorSets",
      "CreateQueryPool", "CreateImage", "CreateImageView", "BindImageMemory", "CreateSampler",
      "GetQueryPoolResults"}},
#ifdef CANDELABRA_RASTER_PASS
    {"RasterPass",
     rasterSteps,
     100,
     1000,
     {"create raster pass", "create targets", "create geometry", "set emitters",
      "set more emitters", "raster statistics"},
     {"CreateBuffer", "AllocateMemory", "BindBufferMemory", "MapMemory", "CreateBufferView",
      "CreateShaderModule", "CreateComputePipelines", "CreateGraphicsPipelines",
      "CreatePipelineLayout", "CreateDescriptorSetLayout", "CreateDescriptorPool",
      "AllocateDescriptorSets", "CreateQueryPool", "CreateImage", "CreateImageView",
      "BindImageMemory", "CreateSampler", "GetQueryPoolResults"}},
#endif
    {"Occluders",
     occluderSteps,
     100,
     1000,
     {"create lighting", "create view", "add mesh", "add occluders", "add a larger mesh",
      "add more occluders", "use positions on the device"},
     {"CreateBuffer", "AllocateMemory", "BindBufferMemory", "MapMemory", "CreateBufferView",
      "CreateShaderModule", "CreateComputePipelines", "CreatePipelineLayout",
      "CreateDescriptorSetLayout", "CreateDescriptorPool", "AllocateDescriptorSets"}},
};

// With the sanitizers runs take ten times as long, and tests do less there unless --full is given.
bool doesLess()
{
    return sanitized && !fullTests();
}

// Returns the indices of the calls that are to fail, of those that the steps make. These are all
// calls. Where tests do less, they are the first two and every eighth call of one function in one
// step. Most calls are similar, because the same lines make all pipelines and all buffers.
std::vector<uint64_t> callsToFail(const std::vector<Step>& steps)
{
    Host h;
    std::vector<uint64_t> out;
    for (const Step& step : steps) {
        uint64_t call = h.vulkan.failableCalls.size();
        runStep(step, h, nullptr);
        std::map<std::string_view, int> counts;
        for (; call < h.vulkan.failableCalls.size(); ++call) {
            const int before = counts[h.vulkan.failableCalls[call]]++;
            if (!doesLess() || before < 2 || before % 8 == 0)
                out.push_back(call);
        }
    }
    return out;
}

class Faults : public ::testing::TestWithParam<Family>
{
protected:
    const std::vector<Step>& all_ = GetParam().steps();
};

} // namespace

TEST_P(Faults, EveryVulkanCallFailsInTurn)
{
    uint64_t calls = 0;
    {
        Host h;
        EXPECT_EQ(runSteps(all_, h, CND_SUCCESS, VK_SUCCESS), "");
        calls = h.vulkan.failableCalls.size();
        expectClean(h, "without faults");
    }
    ASSERT_GT(calls, GetParam().calls);
    const std::vector<uint64_t> failing = callsToFail(all_);
    std::cout << failing.size() << " of " << calls << " calls that can fail\n";
    std::map<std::string, int> failures; // by step
    std::set<std::string> functions;
    constexpr std::array errors{VK_ERROR_OUT_OF_HOST_MEMORY, VK_ERROR_OUT_OF_DEVICE_MEMORY,
                                VK_ERROR_DEVICE_LOST};
    for (size_t i = 0; i < failing.size() && !HasFailure(); ++i)
        for (size_t e = 0; e < errors.size(); ++e) {
            // Each call fails with one of the errors, in turn; with --full, with all of them.
            if (!fullTests() && e != i % errors.size())
                continue;
            const uint64_t call = failing[i];
            const VkResult error = errors[e];
            Host h;
            h.vulkan.failingCall = call;
            h.vulkan.error = error;
            const CndResult expected =
                error == VK_ERROR_DEVICE_LOST ? CND_ERROR_DEVICE : CND_ERROR_OUT_OF_MEMORY;
            ++failures[runSteps(all_, h, expected, error)];
            functions.insert(h.vulkan.failed);
            expectClean(h, h.vulkan.failed + " failing, call " + std::to_string(call));
        }
    for (const char* name : GetParam().failing)
        EXPECT_GT(failures[name], 0) << name;
    for (const char* name : GetParam().functions)
        EXPECT_TRUE(functions.contains(name)) << name << " never failed";
}

TEST_P(Faults, TheHeapFailsInTurn)
{
    uint64_t total = 0;
    for (int i = 0; i < 2; ++i) { // the first run also allocates what lives as long as the program
        Host h;
        const HostAllocations allocations;
        for (const Step& step : all_)
            runStep(step, h, nullptr);
        total = allocations.count();
    }
    ASSERT_GT(total, GetParam().allocations);
    std::cout << total << " allocations\n";
    // Tries the first allocations one by one, then ever larger strides: most are similar, from
    // reading SPIR-V.
    const uint64_t oneByOne = doesLess() ? 20 : 100;
    for (uint64_t failing = 0; failing < total && !HasFailure();
         failing += 1 + failing / oneByOne) {
        Host h;
        int failures = 0;
        {
            const HostAllocations allocations(failing);
            for (const Step& step : all_) {
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

// Also checks that no function is looked up that submits, waits or takes a queue.
TEST_P(Faults, RecordingOnlyRecords)
{
    Host h;
    for (const Step& step : all_) {
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
        const std::string_view verb(step.name, std::string_view(step.name).find(' '));
        EXPECT_TRUE(h.vulkan.called.contains(verb == "upload" ? "CmdCopyBuffer"
                                             : verb == "save" ? "CmdCopyImageToBuffer"
                                             : verb == "load" ? "CmdCopyBufferToImage"
                                                              : "CmdDispatch"))
            << step.name;
        std::set<std::string> mayCall = {"UpdateDescriptorSets"};
        if (h.raster) // buffers that a larger set of emitters replaced
            mayCall.insert({"DestroyBuffer", "FreeMemory"});
        for (const std::string& name : h.vulkan.called)
            EXPECT_TRUE(name.starts_with("Cmd") || mayCall.contains(name)) << name;
    }
    for (const std::string& name : h.vulkan.lookedUp)
        for (const char* never : {"Queue", "Wait", "Fence", "Semaphore", "Event"})
            EXPECT_TRUE(name == "CreateQueryPool" || name.find(never) == std::string::npos) << name;
    EXPECT_GT(h.vulkan.lookedUp.size(), 20u);
}

TEST_P(Faults, MissingFunctionsAreNamed)
{
    std::set<std::string> functions;
    {
        Host h;
        ASSERT_EQ(all_[0].run(h, nullptr), CND_SUCCESS);
        functions = h.vulkan.lookedUp;
    }
    for (const std::string& name : functions) {
        Host h;
        h.vulkan.absent = name;
        CndError error{};
        EXPECT_EQ(all_[0].run(h, &error), CND_ERROR_UNSUPPORTED) << name;
        EXPECT_NE(std::string(error.message).find("vk" + name), std::string::npos) << error.message;
        EXPECT_FALSE(h.lighting || h.raster);
    }
}

TEST_P(Faults, CreatedManyTimesNothingGrows)
{
    Host h;
    const int times = fullTests() ? 1000 : sanitized ? 30 : 200;
    for (int i = 0; i < times && !HasFailure(); ++i) {
        for (const Step& step : all_) {
            CndError error{};
            ASSERT_EQ(runStep(step, h, &error), CND_SUCCESS) << step.name << ": " << error.message;
        }
        expectClean(h, "round " + std::to_string(i));
    }
    EXPECT_TRUE(h.vulkan.memories.empty());
    EXPECT_TRUE(h.vulkan.buffers.empty());
}

INSTANTIATE_TEST_SUITE_P(OfAll, Faults, ::testing::ValuesIn(families),
                         [](const auto& test) { return test.param.name; });

} // namespace candelabra::test
