// SPDX-License-Identifier: Apache-2.0
// Tests the needs of each module. Everything that is listed has its own sentence when it
// is missing, and the code of the module's kernels needs no more and no less.
#include <algorithm>
#include <cstring>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "candelabra/candelabra.hpp"
#include "gpu/requirements.h"
#include "gpu/spirv.h"
#include "gpu/spirv_words.h"
#include "mock/mock_vulkan.h"
#include "shared/specular_methods.h"

namespace candelabra::test
{
namespace
{

constexpr uint32_t L = CND_MODULE_LIGHTING_BIT, E = CND_MODULE_ENVIRONMENT_BIT,
                   X = CND_MODULE_EXPOSURE_BIT;
constexpr uint32_t modules[] = {L, E, X};

// Creates a module with everything that it can have. Returns its error message.
std::string create(const CndDeviceDesc& device, uint32_t module)
{
    constexpr uint32_t allTypes = (1u << CND_LIGHT_TYPE_COUNT) - 1;
    if (module == L) {
        auto lighting = Lighting::create(device, {.framesInFlight = 1,
                                                  .specularMethods = gpu::ALL_SPECULAR_METHODS,
                                                  .forwardStages = VK_SHADER_STAGE_FRAGMENT_BIT,
                                                  .diffuseOnlyTiles = VK_TRUE,
                                                  .lightTypes = allTypes,
                                                  .influenceByError = VK_TRUE});
        return lighting ? "" : lighting.error().message;
    }
    if (module == E)
        return Environment::create(device, {.framesInFlight = 1}).error().message;
    return Exposure::create(device, {.framesInFlight = 1}).error().message;
}

std::string checked(const CndDeviceDesc& device, uint32_t mask)
{
    return checkDevice(device, mask).error().message;
}

// Something that a device may lack, its name, and the modules that need it.
struct Lack {
    const char* name;
    uint32_t needed;
    std::function<void(MockVulkan&)> take;
};

const Lack lacks[] = {
    {"feature scalarBlockLayout", L | E, [](auto& v) { v.lackingFeature = "scalarBlockLayout"; }},
    {"maxComputeWorkGroupInvocations of at least 256", X,
     [](auto& v) { v.limits.maxComputeWorkGroupInvocations = 255; }},
    {"maxComputeWorkGroupSize[0] of at least 256", X,
     [](auto& v) { v.limits.maxComputeWorkGroupSize[0] = 128; }},
    {"maxPerStageDescriptorStorageBuffers of at least 10", L,
     [](auto& v) { v.limits.maxPerStageDescriptorStorageBuffers = 9; }},
    {"subgroup votes, ballots and arithmetic in compute shaders", L,
     [](auto& v) { v.subgroupOperations = ~VK_SUBGROUP_FEATURE_BALLOT_BIT; }},
    {"linear filtering of VK_FORMAT_R32G32B32A32_SFLOAT", E,
     [](auto& v) { v.lackingFormatFeatures = VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT; }},
    {"memory that the CPU can write", L | E | X,
     [](auto& v) { v.lackingMemory = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT; }},
    {"Vulkan 1.1 (the device has 1.0)", L | E | X,
     [](auto& v) { v.apiVersion = VK_API_VERSION_1_0; }}};

TEST(Requirements, WhatADeviceLacksIsNamedByTheModulesThatNeedIt)
{
    for (const Lack& lack : lacks) {
        MockVulkan vulkan;
        lack.take(vulkan);
        const std::string sentence = std::string("the device lacks: ") + lack.name;
        for (const uint32_t module : modules) {
            const std::string expected = module & lack.needed ? sentence : "";
            EXPECT_EQ(checked(vulkan.desc(), module), expected) << lack.name;
            EXPECT_EQ(create(vulkan.desc(), module), expected) << lack.name << " " << module;
        }
        EXPECT_EQ(checked(vulkan.desc(), 0), sentence);
        EXPECT_TRUE(vulkan.alive.empty());
    }
    MockVulkan several;
    lacks[0].take(several);
    lacks[3].take(several);
    EXPECT_EQ(checked(several.desc(), L),
              std::string("the device lacks: ") + lacks[0].name + ", " + lacks[3].name);
    EXPECT_EQ(checked(several.desc(), 8),
              "cndCheckDevice: modules must be a mask of CndModuleBits");
    CndError error{};
    EXPECT_EQ(cndCheckDevice(nullptr, 0, &error), CND_ERROR_INVALID_ARGUMENT);
}

TEST(Requirements, TheRasterPassNamesWhatItAloneNeeds)
{
    const auto missing = [](MockVulkan& vulkan, gpu::Parts parts) {
        const CndDeviceDesc desc = vulkan.desc();
        return gpu::missingNeeds(gpu::InstanceFunctions(desc), desc, parts);
    };
    for (const char* feature : {"multiDrawIndirect", "drawIndirectFirstInstance",
                                "dynamicRendering", "synchronization2", "scalarBlockLayout"}) {
        MockVulkan vulkan;
        EXPECT_EQ(missing(vulkan, gpu::rasterPass), "");
        vulkan.lackingFeature = feature;
        EXPECT_EQ(missing(vulkan, gpu::rasterPass), std::string("feature ") + feature);
        EXPECT_EQ(missing(vulkan, gpu::exposureModule), "");
    }
    MockVulkan vulkan;
    vulkan.lackingFormatFeatures = VK_FORMAT_FEATURE_DEPTH_STENCIL_ATTACHMENT_BIT;
    EXPECT_EQ(missing(vulkan, gpu::rasterPass), "depth attachments of VK_FORMAT_D32_SFLOAT");
    EXPECT_EQ(missing(vulkan, gpu::allModules), "");
    vulkan.lackingFormatFeatures = 0;
    vulkan.apiVersion = VK_API_VERSION_1_2;
    EXPECT_EQ(missing(vulkan, gpu::rasterPass), "Vulkan 1.3 (the device has 1.2)");
}

TEST(Requirements, FeaturesAreSetInWhicheverStructHasThem)
{
    for (const uint32_t mask : {0u, L, E, X, L | X}) {
        const bool wanted = mask != X;
        VkPhysicalDeviceVulkan12Features core12{
            .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES};
        VkPhysicalDeviceMultiviewFeatures other{
            .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MULTIVIEW_FEATURES, .pNext = &core12};
        VkPhysicalDeviceFeatures2 features{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2,
                                           .pNext = &other};
        EXPECT_TRUE(requireFeatures(features, mask));
        VkPhysicalDeviceVulkan12Features expected{
            .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES,
            .scalarBlockLayout = wanted};
        EXPECT_EQ(std::memcmp(&core12, &expected, sizeof expected), 0) << mask;
        VkPhysicalDeviceFeatures2 untouched{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2,
                                            .pNext = &other};
        EXPECT_EQ(std::memcmp(&features, &untouched, sizeof untouched), 0) << mask;

        VkPhysicalDeviceScalarBlockLayoutFeatures scalar{
            .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SCALAR_BLOCK_LAYOUT_FEATURES};
        features.pNext = &scalar;
        EXPECT_TRUE(requireFeatures(features, mask));
        EXPECT_EQ(scalar.scalarBlockLayout, VkBool32(wanted)) << mask;

        features.pNext = nullptr;
        const auto result = requireFeatures(features, mask);
        EXPECT_EQ(bool(result), !wanted) << mask;
        if (wanted) {
            EXPECT_STREQ(result.error().message,
                         "cndRequireFeatures: no struct of the chain has the feature "
                         "scalarBlockLayout: chain a VkPhysicalDeviceVulkan12Features or "
                         "VkPhysicalDeviceScalarBlockLayoutFeatures");
        }
    }
    VkPhysicalDeviceFeatures2 features{};
    EXPECT_STREQ(requireFeatures(features, 16).error().message,
                 "cndRequireFeatures: modules must be a mask of CndModuleBits");
}

// An instance of Vulkan 1.0, which a physical device of Vulkan 1.3 does not show.
TEST(Requirements, AnInstanceThatIsTooOldIsNamed)
{
    MockVulkan vulkan;
    vulkan.ignoresChains = true;
    const std::string sentence = "the instance was created for Vulkan 1.0, Candelabra needs 1.1: "
                                 "set VkApplicationInfo::apiVersion to VK_API_VERSION_1_1 or newer";
    EXPECT_EQ(checked(vulkan.desc(), 0), sentence);
    for (const uint32_t module : modules)
        EXPECT_EQ(create(vulkan.desc(), module), sentence);
    vulkan.ignoresChains = false;
    CndDeviceDesc device = vulkan.desc();
    device.apiVersion = VK_API_VERSION_1_0;
    const auto stated = checkDevice(device);
    EXPECT_EQ(stated.error().code, CND_ERROR_UNSUPPORTED);
    EXPECT_STREQ(stated.error().message,
                 "CndDeviceDesc: apiVersion is 1.0, Candelabra needs 1.1: set "
                 "VkApplicationInfo::apiVersion, and apiVersion here, to VK_API_VERSION_1_1 or "
                 "newer");
    EXPECT_EQ(create(device, X), stated.error().message);
}

TEST(Requirements, Vulkan11NeedsAnExtension)
{
    MockVulkan vulkan;
    for (const bool deviceIsOld : {true, false}) {
        CndDeviceDesc device = vulkan.desc();
        vulkan.apiVersion = deviceIsOld ? VK_API_VERSION_1_1 : VK_API_VERSION_1_3;
        device.apiVersion = deviceIsOld ? 0 : VK_API_VERSION_1_1;
        vulkan.extensions = {"VK_KHR_swapchain"};
        EXPECT_EQ(checked(device, L), "the device lacks: feature scalarBlockLayout "
                                      "(VK_EXT_scalar_block_layout, or Vulkan 1.2)");
        EXPECT_EQ(create(device, X), ""); // needs no feature
        vulkan.extensions.insert(VK_EXT_SCALAR_BLOCK_LAYOUT_EXTENSION_NAME);
        for (const uint32_t module : modules)
            EXPECT_EQ(create(device, module), "");
        vulkan.lackingFeature = "scalarBlockLayout";
        EXPECT_EQ(checked(device, L), "the device lacks: feature scalarBlockLayout");
        vulkan.lackingFeature = "";
    }
}

// With older versions, nothing is used that only Vulkan 1.3 guarantees.
TEST(Requirements, FormatsThatShadersDoNotNameNeedVulkan13)
{
    MockVulkan vulkan;
    CndDeviceDesc device = vulkan.desc();
    const auto message = [&](VkFormat format) {
        return std::string(Exposure::create(device, {.framesInFlight = 1, .displayFormat = format})
                               .error()
                               .message);
    };
    EXPECT_EQ(message(VK_FORMAT_B8G8R8A8_UNORM), "");
    device.apiVersion = VK_API_VERSION_1_2;
    EXPECT_EQ(message(VK_FORMAT_R8G8B8A8_UNORM), "");
    EXPECT_NE(message(VK_FORMAT_B8G8R8A8_UNORM).find("need Vulkan 1.3"), std::string::npos);
    device.apiVersion = 0;
    vulkan.apiVersion = VK_API_VERSION_1_2;
    EXPECT_NE(message(VK_FORMAT_B8G8R8A8_UNORM).find("need Vulkan 1.3"), std::string::npos);
}

// The needs of the code of a module's kernels.
struct CodeNeeds {
    uint32_t version = 0, lanes = 0, storageBuffers = 0;
    std::set<uint32_t> capabilities;
};

CodeNeeds needsOf(const std::vector<std::vector<uint32_t>>& shaders)
{
    constexpr uint32_t opExecutionMode = 16, localSize = 17;
    CodeNeeds out;
    for (const std::vector<uint32_t>& words : shaders) {
        out.version = std::max(out.version, words[1]);
        for (size_t i = gpu::headerWords; i < words.size(); i += words[i] >> 16) {
            const uint32_t* at = &words[i];
            if (gpu::opcode(at) == gpu::OpCapability)
                out.capabilities.insert(at[1]);
            if (gpu::opcode(at) == opExecutionMode && at[2] == localSize)
                out.lanes = std::max(out.lanes, at[3] * at[4] * at[5]);
        }
        const gpu::Reflection reflection = gpu::reflect({"kernel", words});
        const auto buffers = std::count_if(
            reflection.bindings.begin(), reflection.bindings.end(),
            [](const auto& b) { return b.type == VK_DESCRIPTOR_TYPE_STORAGE_BUFFER; });
        out.storageBuffers = std::max(out.storageBuffers, uint32_t(buffers));
    }
    return out;
}

// The numbers of SPIR-V 1.3 that need no feature of the device.
enum Capability : uint32_t {
    Shader = 1,
    SampledBuffer = 46,
    ImageQuery = 50,
    GroupNonUniform = 61,
    GroupNonUniformVote = 62,
    GroupNonUniformArithmetic = 63,
    GroupNonUniformBallot = 64,
};

TEST(Requirements, TheCodeOfKernelsNeedsWhatIsListed)
{
    constexpr uint32_t spirv13 = 0x00010300, guaranteedLanes = 128, guaranteedBuffers = 4;
    for (const uint32_t module : modules) {
        MockVulkan vulkan;
        std::vector<std::vector<uint32_t>> shaders;
        vulkan.shaders = &shaders;
        ASSERT_EQ(create(vulkan.desc(), module), "");
        ASSERT_GE(shaders.size(), 3u);
        const CodeNeeds needs = needsOf(shaders);
        EXPECT_EQ(needs.version, spirv13) << module; // the newest of Vulkan 1.1
        if (module == L) {
            EXPECT_EQ(
                needs.capabilities,
                (std::set<uint32_t>{Shader, SampledBuffer, GroupNonUniform, GroupNonUniformVote,
                                    GroupNonUniformArithmetic, GroupNonUniformBallot}));
            EXPECT_EQ(needs.storageBuffers, gpu::maxStorageBuffers(gpu::lightingModule));
            EXPECT_LE(needs.lanes, guaranteedLanes);
        } else if (module == E) {
            EXPECT_EQ(needs.capabilities, (std::set<uint32_t>{Shader, SampledBuffer, ImageQuery}));
            EXPECT_LE(needs.storageBuffers, guaranteedBuffers);
            EXPECT_LE(needs.lanes, guaranteedLanes);
        } else {
            EXPECT_EQ(needs.capabilities, std::set<uint32_t>{Shader});
            EXPECT_LE(needs.storageBuffers, guaranteedBuffers);
            EXPECT_EQ(needs.lanes, 256u);
        }
    }
}

} // namespace
} // namespace candelabra::test
