// SPDX-License-Identifier: Apache-2.0
// Devices that lack something: the host's functions are interposed to hide a limit.
#include "candelabra/candelabra.hpp"
#include "gpu/gpu_like_device.h"
#include "gpu/lighting_harness.h"

namespace candelabra::test
{
namespace
{

// Global because Vulkan's function pointers carry no context.
PFN_vkGetInstanceProcAddr realGetInstanceProcAddr = nullptr;
PFN_vkGetPhysicalDeviceProperties2 realGetProperties = nullptr;

void VKAPI_CALL propertiesWithSmallTexelBuffers(VkPhysicalDevice device,
                                                VkPhysicalDeviceProperties2* properties)
{
    realGetProperties(device, properties);
    properties->properties.limits.maxTexelBufferElements = 65536; // Vulkan's guaranteed minimum
}

template <typename F>
F find(const CndDeviceDesc& desc, const char* name)
{
    return reinterpret_cast<F>(desc.getInstanceProcAddr(desc.instance, name));
}

PFN_vkVoidFunction VKAPI_CALL poorInstanceProcAddr(VkInstance instance, const char* name)
{
    const std::string function = name;
    if (function == "vkGetPhysicalDeviceProperties2")
        return reinterpret_cast<PFN_vkVoidFunction>(propertiesWithSmallTexelBuffers);
    return realGetInstanceProcAddr(instance, name);
}

CndDeviceDesc poorDevice(const CndDeviceDesc& host)
{
    realGetInstanceProcAddr = host.getInstanceProcAddr;
    realGetProperties =
        find<PFN_vkGetPhysicalDeviceProperties2>(host, "vkGetPhysicalDeviceProperties2");
    CndDeviceDesc desc = host;
    desc.getInstanceProcAddr = poorInstanceProcAddr;
    return desc;
}

} // namespace

// "Not yet" and "never" are different answers.
TEST_F(LightingTest, StatsOfFramesThatNeverWereAreAnError)
{
    auto lighting = Lighting::create(deviceDesc(), {.framesInFlight = 2});
    ASSERT_TRUE(lighting) << lighting.error().message;
    auto view = lighting.value().createView({.maxWidth = 8, .maxHeight = 8});
    ASSERT_TRUE(view) << view.error().message;
    auto exposure = Exposure::create(deviceDesc(), {.framesInFlight = 2});
    ASSERT_TRUE(exposure) << exposure.error().message;
    for (const uint32_t slot : {0u, 2u}) { // never recorded, and not existing
        EXPECT_EQ(view.value().stats(slot).error().code, CND_ERROR_INVALID_ARGUMENT) << slot;
        EXPECT_EQ(exposure.value().stats(slot).error().code, CND_ERROR_INVALID_ARGUMENT) << slot;
    }
}

// The choices of the engine for GPUs, such as reading lights from storage buffers and making lists
// by groups of lanes, gives the bits of what it chooses for llvmpipe, also with little memory for
// lists.
TEST_F(LightingTest, FormsForGpusGiveTheSameBits)
{
    const CpuGBuffer g = randomGBuffer(96, 64, 12);
    std::vector<CndLight> mixed;
    for (uint32_t type = 0; type < CND_LIGHT_TYPE_COUNT; ++type) {
        const auto ofType = lightsOf(CndLightType(type), g, 40, 12 + type);
        mixed.insert(mixed.end(), ofType.begin(), ofType.end());
    }
    const CndDeviceDesc gpu = gpuLike(deviceDesc());
    const auto compare = [&](const std::vector<CndLight>& lights, VkDeviceSize listBudget) {
        RunOptions options{.specular = CND_SPECULAR_CONIC, .listBudget = listBudget};
        const LightingResult expected = run(g, lights, options);
        options.host = &gpu;
        const LightingResult got = run(g, lights, options);
        EXPECT_TRUE(sameBits(got, expected));
        if (listBudget == 0) {
            EXPECT_EQ(got.stats.listEntries, expected.stats.listEntries);
        } else {
            EXPECT_GT(got.stats.unlistedClusters, 0u);
        }
    };
    compare(lightsOf(CND_LIGHT_SPHERE, g, 500, 12), 0);
    compare(lightsOf(CND_LIGHT_SPHERE, g, 2000, 13), 4096);
    compare(lightsOf(CND_LIGHT_TUBE, g, 500, 12), 0);
    compare(mixed, 0);
}

// GPUs read the lights of several tests at once (READS_AHEAD in shading/classify_lights.glsl).
// This gives the same bits for small and large spheres, and for lists of any length up to a page,
// and of several pages.
TEST_F(LightingTest, LightsReadAheadGiveTheSameBits)
{
    const CpuGBuffer g = randomGBuffer(75, 53, 31);
    const CndDeviceDesc gpu = gpuLike(deviceDesc());
    for (const float radius : {0.01f, 0.3f, 3.0f}) {
        auto lights = randomSpheres(g, 900, 31);
        for (CndLight& light : lights) {
            light.radius = radius;
            light.influenceRadius = 8;
        }
        const RunOptions options{.specular = CND_SPECULAR_CONIC};
        RunOptions onGpu = options;
        onGpu.host = &gpu;
        EXPECT_TRUE(sameBits(run(g, lights, onGpu), run(g, lights, options))) << radius;
    }
    for (const uint32_t count : {1u, 3u, 4u, 5u, 31u, 32u, 33u, 63u, 64u}) {
        auto lights = randomSpheres(g, count, 33);
        for (CndLight& light : lights)
            light.influenceRadius = 100;
        RunOptions options{.specular = CND_SPECULAR_CONIC};
        const LightingResult expected = run(g, lights, options);
        options.host = &gpu;
        EXPECT_TRUE(sameBits(run(g, lights, options), expected)) << count;
    }
}

// Devices with small texel buffers read lights from storage buffers, which must give the same bits.
TEST_F(LightingTest, SmallTexelBuffersChangeNothing)
{
    const CpuGBuffer g = randomGBuffer(96, 64, 12);
    const auto lights = randomSpheres(g, 500, 12);
    const CndDeviceDesc poor = poorDevice(deviceDesc());
    const LightingResult texels = run(g, lights);
    const LightingResult words = run(g, lights, {.host = &poor});
    EXPECT_EQ(maxRelativeDifference(words.radiance, texels.radiance), 0);
}

} // namespace candelabra::test
