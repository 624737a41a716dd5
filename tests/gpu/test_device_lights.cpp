// SPDX-License-Identifier: Apache-2.0
// Lights that are written on the device give the same image as lights from the host and none is
// lost. Invalid ones are counted and show nothing.
#include <cstring>
#include <limits>

#include "gpu/lighting_harness.h"
#include "harness/constants.h"

namespace candelabra::test
{
namespace
{

constexpr float notANumber = std::numeric_limits<float>::quiet_NaN();

CndDeviceLight onDevice(const CndLight& light)
{
    CndDeviceLight out{.radius = light.radius, .influenceRadius = light.influenceRadius};
    std::memcpy(out.position, light.position, sizeof out.position);
    std::memcpy(out.emission, light.emission, sizeof out.emission);
    return out;
}

class DeviceLightsTest : public LightingTest
{
protected:
    // Creates a buffer of the host, as a simulation would leave it.
    gpu::Buffer buffer(size_t bytes)
    {
        return gpu::createBuffer(device(), "particles", bytes, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
                                 gpu::MemoryUse::Upload);
    }
    void fill(const std::vector<CndLight>& lights)
    {
        lights_ = buffer(lights.size() * sizeof(CndDeviceLight));
        for (size_t i = 0; i < lights.size(); ++i)
            lights_.as<CndDeviceLight>()[i] = onDevice(lights[i]);
        count_ = buffer(sizeof(uint32_t));
    }
    CndDeviceLights desc(CndLightType type, uint32_t maxCount, uint32_t count)
    {
        count_.as<uint32_t>()[0] = count;
        return {.type = type,
                .maxCount = maxCount,
                .buffer = lights_.get(),
                .countBuffer = count_.get(),
                .boundsMin = {-10, -10, -20},
                .boundsMax = {10, 10, 0},
                .influenceRadius = 2};
    }
    void SetUp() override
    {
        LightingTest::SetUp();
        if (IsSkipped() || HasFatalFailure())
            return;
        g_ = randomGBuffer(128, 96, 3);
    }

    CpuGBuffer g_;
    gpu::Buffer lights_, count_;
};

TEST_F(DeviceLightsTest, GiveTheSameImageAsFromTheHost)
{
    std::vector<CndLight> spheres = randomSpheres(g_, 500, 7);
    for (const CndLightType type : {CND_LIGHT_SPHERE, CND_LIGHT_POINT}) {
        for (CndLight& light : spheres)
            light.type = type;
        std::vector<CndLight> more = spheres; // more than the count says
        more.resize(700, spheres[0]);
        fill(more);
        std::vector<CndLight> others = randomSpheres(g_, 40, 8);
        for (size_t i = 0; i < others.size(); ++i)
            others[i].type = i % 2 ? CND_LIGHT_POINT : CND_LIGHT_SPHERE;
        std::vector<CndLight> all = others;
        all.insert(all.end(), spheres.begin(), spheres.end());
        const LightingResult fromHost = run(g_, all);
        const CndDeviceLights device = desc(type, 700, 500);
        for (const CndCulling culling : {CND_CULLING_CLUSTERED, CND_CULLING_BRUTE}) {
            const LightingResult mixed =
                run(g_, others, {.culling = culling, .deviceLights = &device});
            EXPECT_EQ(mixed.stats.lightCount, 740u);
            EXPECT_EQ(mixed.stats.deviceLights, 500u);
            EXPECT_EQ(mixed.stats.rejectedLights, 0u);
            // The order of lights differs, because it follows boundsMin and boundsMax.
            EXPECT_LE(maxRelativeDifference(mixed.radiance, fromHost.radiance), 1e-6);
        }
        EXPECT_TRUE(sameBits(run(g_, others, {.deviceLights = &device}).radiance,
                             run(g_, others, {.deviceLights = &device}).radiance));
        const LightingResult alone = run(g_, {}, {.deviceLights = &device});
        const LightingResult aloneFromHost = run(g_, spheres);
        EXPECT_LE(maxRelativeDifference(alone.radiance, aloneFromHost.radiance), 1e-6);
        EXPECT_GT(maxRelativeDifference(alone.radiance, fromHost.radiance), 1e-3);
    }
}

TEST_F(DeviceLightsTest, AreCutByAnErrorLikeThoseOfTheHost)
{
    std::vector<CndLight> spheres = randomSpheres(g_, 150, 17);
    for (size_t i = 10; i < spheres.size(); ++i)
        spheres[i].radius = 0.01f; // makes the light dim
    fill(spheres);
    const CndDeviceLights device = desc(CND_LIGHT_SPHERE, 150, 150);
    const CndInfluence influence{
        .rule = CND_INFLUENCE_BY_ERROR, .maxError = 0.1f, .exposure = 0.003f};
    const LightingResult fromHost = run(g_, spheres, {.influence = influence});
    const LightingResult fromDevice =
        run(g_, {}, {.deviceLights = &device, .influence = influence});
    EXPECT_GT(fromHost.stats.cutBelow, 0);
    EXPECT_EQ(fromDevice.stats.cutBelow, fromHost.stats.cutBelow);
    EXPECT_LE(maxRelativeDifference(fromDevice.radiance, fromHost.radiance), 1e-6);
}

TEST_F(DeviceLightsTest, WhatIsNoLightShowsNothingAndIsCounted)
{
    const std::vector<CndLight> good = randomSpheres(g_, 60, 9);
    std::vector<CndLight> all = good;
    const auto bad = [&](auto change) {
        all.push_back(good[all.size() % good.size()]);
        change(all.back());
    };
    bad([](CndLight& l) { l.position[1] = notANumber; });
    bad([](CndLight& l) { l.position[0] = -infinity; });
    bad([](CndLight& l) { l.position[2] = 2e15f; });
    bad([](CndLight& l) { l.radius = 0; });
    bad([](CndLight& l) { l.radius = notANumber; });
    bad([](CndLight& l) { l.radius = -1; });
    bad([](CndLight& l) { l.emission[1] = -1; });
    bad([](CndLight& l) { l.emission[2] = infinity; });
    bad([](CndLight& l) { l.emission[0] = notANumber; });
    bad([](CndLight& l) { l.influenceRadius = l.radius; });
    bad([](CndLight& l) { l.influenceRadius = notANumber; });
    const uint32_t badCount = uint32_t(all.size() - good.size());
    std::swap(all.front(), all.back()); // puts an invalid light before the valid ones too
    fill(all);
    const LightingResult expected = run(g_, good);
    for (const CndCulling culling : {CND_CULLING_CLUSTERED, CND_CULLING_BRUTE}) {
        // The count is 5 higher than the capacity.
        const CndDeviceLights device =
            desc(CND_LIGHT_SPHERE, uint32_t(all.size()), uint32_t(all.size()) + 5);
        const LightingResult result = run(g_, {}, {.culling = culling, .deviceLights = &device});
        EXPECT_EQ(result.stats.deviceLights, good.size());
        EXPECT_EQ(result.stats.rejectedLights, badCount + 5);
        EXPECT_LE(maxRelativeDifference(result.radiance, expected.radiance), 1e-6);
    }
}

TEST_F(DeviceLightsTest, AreReadAgainWithEverySet)
{
    const std::vector<CndLight> first = randomSpheres(g_, 50, 10),
                                second = randomSpheres(g_, 50, 11);
    fill(first);
    CndDeviceLights device = desc(CND_LIGHT_SPHERE, 50, 0); // none at first
    const auto own = createLighting(g_, 2);
    const Images images = uploadImages(g_);
    CndError error{};
    const auto frame = [&](uint32_t slot) {
        const CndLightSet set{.structSize = sizeof set, .deviceLights = &device};
        EXPECT_EQ(cndSetLights(own.lighting, &set, &error), CND_SUCCESS) << error.message;
        CndLightingFrame f = frameOf(g_, images, {});
        f.frameSlot = slot;
        return drawFrame(own.view, f, images);
    };
    for (const glm::vec4& pixel : frame(0))
        EXPECT_EQ(glm::vec3(pixel), glm::vec3(0));
    count_.as<uint32_t>()[0] = 50;
    EXPECT_LE(maxRelativeDifference(frame(1), run(g_, first).radiance), 1e-6);
    for (size_t i = 0; i < second.size(); ++i)
        lights_.as<CndDeviceLight>()[i] = onDevice(second[i]);
    EXPECT_LE(maxRelativeDifference(frame(0), run(g_, second).radiance), 1e-6);
    device.countBuffer = VK_NULL_HANDLE;
    device.maxCount = 20;
    const std::vector<CndLight> some(second.begin(), second.begin() + 20);
    EXPECT_LE(maxRelativeDifference(frame(1), run(g_, some).radiance), 1e-6);
}

TEST_F(DeviceLightsTest, StayWhenLightsAreAddedBesideThem)
{
    const std::vector<CndLight> spheres = randomSpheres(g_, 60, 13);
    fill(spheres);
    const CndDeviceLights device = desc(CND_LIGHT_SPHERE, 60, 60);
    const auto own = createLighting(g_, 2);
    const Images images = uploadImages(g_);
    CndError error{};
    std::vector<CndLight> all = spheres;
    CndLightingFrame f = frameOf(g_, images, {});
    const auto addAndCompare = [&](uint32_t count) { // adds lights, which need larger buffers
        const std::vector<CndLight> more = randomSpheres(g_, count, count);
        std::vector<CndLightId> ids(count);
        EXPECT_EQ(cndAddLights(own.lighting, count, more.data(), ids.data(), &error), CND_SUCCESS);
        all.insert(all.end(), more.begin(), more.end());
        f.frameSlot = 1 - f.frameSlot;
        EXPECT_LE(maxRelativeDifference(drawFrame(own.view, f, images), run(g_, all).radiance),
                  1e-6);
    };
    const CndLightSet set{.structSize = sizeof set, .deviceLights = &device};
    EXPECT_EQ(cndSetLights(own.lighting, &set, &error), CND_SUCCESS) << error.message;
    addAndCompare(1100); // before the lights of the device have been read
    addAndCompare(30);
    addAndCompare(1200);
    setLights(own.lighting, {}); // the same buffers with other records
    all.clear();
    addAndCompare(4000);
    EXPECT_EQ(cndSetLights(own.lighting, &set, &error), CND_SUCCESS) << error.message;
    all = spheres;
    addAndCompare(10);
}

TEST_F(DeviceLightsTest, ArgumentsOutOfRangeAreNamed)
{
    fill(randomSpheres(g_, 10, 12));
    const auto own = createLighting(g_, 1);
    const auto expect = [&](const char* named, CndResult code, auto change) {
        CndDeviceLights device = desc(CND_LIGHT_SPHERE, 10, 10);
        change(device);
        const CndLightSet set{.structSize = sizeof set, .deviceLights = &device};
        CndError error{};
        EXPECT_EQ(cndSetLights(own.lighting, &set, &error), code) << named;
        EXPECT_NE(std::string(error.message).find(named), std::string::npos) << error.message;
    };
    constexpr CndResult argument = CND_ERROR_INVALID_ARGUMENT;
    expect("type", argument, [](CndDeviceLights& d) { d.type = CND_LIGHT_TUBE; });
    expect("maxCount", argument, [](CndDeviceLights& d) { d.maxCount = 0; });
    expect("buffer", argument, [](CndDeviceLights& d) { d.buffer = VK_NULL_HANDLE; });
    expect("offset 1", argument, [](CndDeviceLights& d) { d.offset = 1; });
    expect("countOffset 2", argument, [](CndDeviceLights& d) { d.countOffset = 2; });
    expect("boundsMin", argument, [](CndDeviceLights& d) { d.boundsMin[1] = 11; });
    expect("boundsMin", argument, [](CndDeviceLights& d) { d.boundsMax[0] = infinity; });
    expect("influenceRadius", argument, [](CndDeviceLights& d) { d.influenceRadius = notANumber; });
    expect("layers", argument, [](CndDeviceLights& d) { d.layers = 1u << CND_LAYER_COUNT; });
    expect("4000000000", CND_ERROR_UNSUPPORTED,
           [](CndDeviceLights& d) { d.maxCount = 4000000000u; });
}

} // namespace
} // namespace candelabra::test
