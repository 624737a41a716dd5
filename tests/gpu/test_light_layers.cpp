// SPDX-License-Identifier: Apache-2.0
// Lights of other layers than the frame's: the image is that of a set without them, and so are the
// statistics of the lists.
#include <cstring>
#include <string>

#include "gpu/lighting_harness.h"

namespace candelabra::test
{
namespace
{

class LightLayers : public LightingTest
{
protected:
    void SetUp() override
    {
        LightingTest::SetUp();
        if (IsSkipped() || HasFatalFailure())
            return;
        g_ = randomGBuffer(64, 48, 3);
    }
    // Returns lights of every type, in layers 0 and 2.
    std::vector<CndLight> shown() const
    {
        std::vector<CndLight> all;
        for (uint32_t type = 0; type < CND_LIGHT_TYPE_COUNT; ++type)
            for (CndLight& light : lightsOf(CndLightType(type), g_, 50, 40 + type)) {
                light.layers = type % 2 ? 1 : 5;
                all.push_back(light);
            }
        return all;
    }
    // Adds to each light one of layer 1 at the same place, so that the sorted order of the others
    // stays.
    static std::vector<CndLight> withHidden(const std::vector<CndLight>& lights)
    {
        std::vector<CndLight> all;
        for (const CndLight& light : lights) {
            all.insert(all.end(), 2, light);
            all.back().emission[1] += 100;
            all.back().layers = 2;
        }
        return all;
    }

    CpuGBuffer g_;
};

// With lists, with no room for lists, and with every light at every pixel.
TEST_F(LightLayers, LeaveTheSameBitsAsASetWithoutTheOthers)
{
    CndError error{};
    const auto own = createLighting(g_, CndLightingDesc{.framesInFlight = 1,
                                                        .shading = CND_SHADING_CLUSTERED_BIT |
                                                                   CND_SHADING_BRUTE_BIT |
                                                                   CND_SHADING_COUNT_PAIRS_BIT});
    const CndLightingViewDesc withoutRoom{sizeof withoutRoom, g_.width, g_.height, 4096};
    CndLightingView narrow{}; // has no room for lists
    ASSERT_EQ(cndCreateLightingView(own.lighting, &withoutRoom, &narrow, &error), CND_SUCCESS);
    const Images images = uploadImages(g_);
    const auto frame = [&](CndLightingView view, CndCulling culling, uint32_t layers) {
        const CndLightingFrame f = frameOf(g_, images,
                                           {.specular = CND_SPECULAR_CONIC,
                                            .culling = culling,
                                            .countPairs = true,
                                            .layers = layers});
        std::vector<glm::vec4> radiance = drawFrame(view, f, images);
        return LightingResult{std::move(radiance), statsOf(view)};
    };
    const std::vector<CndLight> lights = shown(), all = withHidden(lights);
    setLights(own.lighting, lights);
    const LightingResult expected = frame(own.view, CND_CULLING_CLUSTERED, 0);
    setLights(own.lighting, all);
    const LightingResult clustered = frame(own.view, CND_CULLING_CLUSTERED, 5);
    EXPECT_TRUE(sameBits(clustered, expected));
    EXPECT_EQ(clustered.stats.lightCount, all.size());
    EXPECT_EQ(clustered.stats.listEntries, expected.stats.listEntries);
    EXPECT_EQ(clustered.stats.maxListLength, expected.stats.maxListLength);
    EXPECT_EQ(clustered.stats.insidePairs, expected.stats.insidePairs);
    EXPECT_EQ(clustered.stats.contributingPairs, expected.stats.contributingPairs);
    EXPECT_GT(clustered.stats.contributingPairs, 0u);
    const LightingResult unlisted = frame(narrow, CND_CULLING_CLUSTERED, 5);
    EXPECT_GT(unlisted.stats.unlistedClusters, 0u);
    EXPECT_TRUE(agree(unlisted.radiance, expected.radiance));
    EXPECT_TRUE(agree(frame(own.view, CND_CULLING_BRUTE, 5).radiance, expected.radiance));
    EXPECT_FALSE(sameBits(frame(own.view, CND_CULLING_CLUSTERED, 0), expected)); // all layers
    cndDestroyLightingView(narrow);
}

TEST_F(LightLayers, ChangeFromFrameToFrameAndByEdits)
{
    std::vector<CndLight> lights = randomSpheres(g_, 100, 5);
    for (size_t i = 0; i < lights.size(); ++i) {
        lights[i].type = i % 2 ? CND_LIGHT_SPHERE : CND_LIGHT_POINT;
        lights[i].layers = 1;
    }
    std::vector<CndLight> all = withHidden(lights);
    const auto own = createLighting(g_, 1);
    const Images images = uploadImages(g_);
    CndError error{};
    setLights(own.lighting, all);
    const auto frame = [&](uint32_t layers) {
        CndLightingFrame f = frameOf(g_, images, {.layers = layers});
        f.surfacesUnchanged = VK_TRUE; // lists are kept while the layers stay the same
        return drawFrame(own.view, f, images);
    };
    std::vector<CndLight> others;
    for (size_t i = 1; i < all.size(); i += 2)
        others.push_back(all[i]);
    const std::vector<glm::vec4> first = run(g_, lights).radiance;
    EXPECT_TRUE(sameBits(frame(1), first));
    EXPECT_TRUE(sameBits(frame(1), first));
    EXPECT_TRUE(sameBits(frame(2), run(g_, others).radiance));
    EXPECT_TRUE(sameBits(frame(1), first));
    // No light is in this layer: nothing runs.
    EXPECT_TRUE(sameBits(frame(8), std::vector<glm::vec4>(first.size(), glm::vec4(0))));
    const CndLightingStats stats = statsOf(own.view);
    bool found = false;
    for (uint32_t i = 0; i < stats.passCount; ++i)
        if (std::string(stats.passes[i].name) == "shade_tiles") {
            EXPECT_STREQ(stats.passes[i].skipped, "no light of the view's layers");
            found = true;
        }
    EXPECT_TRUE(found);
    // The lights swap their layers.
    for (size_t i = 0; i < all.size(); ++i) {
        all[i].layers = 3 & ~all[i].layers;
        const CndLightId id = i;
        ASSERT_EQ(cndUpdateLights(own.lighting, 1, &id, &all[i], &error), CND_SUCCESS)
            << error.message;
    }
    EXPECT_TRUE(sameBits(frame(2), first));
    // More of these lights, in a layer that had none.
    const std::vector<glm::vec4> expected = run(g_, others).radiance;
    for (CndLight& light : others)
        light.layers = 4;
    std::vector<CndLightId> added(others.size());
    ASSERT_EQ(
        cndAddLights(own.lighting, uint32_t(others.size()), others.data(), added.data(), &error),
        CND_SUCCESS)
        << error.message;
    EXPECT_TRUE(sameBits(frame(2), first));
    EXPECT_TRUE(sameBits(frame(4), expected));
}

TEST_F(LightLayers, OfLightsOnTheDevice)
{
    const std::vector<CndLight> lights = randomSpheres(g_, 60, 9);
    const gpu::Buffer buffer =
        gpu::createBuffer(device(), "particles", lights.size() * sizeof(CndDeviceLight),
                          VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, gpu::MemoryUse::Upload);
    for (size_t i = 0; i < lights.size(); ++i) {
        CndDeviceLight& out = buffer.as<CndDeviceLight>()[i];
        out = {.radius = lights[i].radius, .influenceRadius = lights[i].influenceRadius};
        std::memcpy(out.position, lights[i].position, sizeof out.position);
        std::memcpy(out.emission, lights[i].emission, sizeof out.emission);
    }
    CndDeviceLights device{.type = CND_LIGHT_SPHERE,
                           .maxCount = uint32_t(lights.size()),
                           .buffer = buffer.get(),
                           .boundsMin = {-10, -10, -20},
                           .boundsMax = {10, 10, 0},
                           .influenceRadius = 2};
    const LightingResult expected = run(g_, {}, {.deviceLights = &device});
    device.layers = 2;
    const std::vector<glm::vec4> black(expected.radiance.size(), glm::vec4(0));
    for (const CndCulling culling : {CND_CULLING_CLUSTERED, CND_CULLING_BRUTE}) {
        const auto in = [&](uint32_t layers) {
            return run(g_, {}, {.culling = culling, .deviceLights = &device, .layers = layers});
        };
        EXPECT_TRUE(sameBits(in(3), expected));
        const LightingResult none = in(5);
        EXPECT_TRUE(sameBits(none.radiance, black));
        EXPECT_EQ(none.stats.deviceLights, lights.size());
    }
    // Beside lights of the host of the same type. Sums are formed in the order of all lights.
    std::vector<CndLight> hosts = randomSpheres(g_, 60, 10);
    const LightingResult hostsAlone = run(g_, hosts);
    for (CndLight& light : hosts)
        light.layers = 1;
    for (const CndCulling culling : {CND_CULLING_CLUSTERED, CND_CULLING_BRUTE}) {
        const auto in = [&](uint32_t layers) {
            return run(g_, hosts, {.culling = culling, .deviceLights = &device, .layers = layers})
                .radiance;
        };
        EXPECT_LE(maxRelativeDifference(in(1), hostsAlone.radiance), 1e-6);
        EXPECT_LE(maxRelativeDifference(in(2), expected.radiance), 1e-6);
        EXPECT_GT(maxRelativeDifference(in(0), expected.radiance), 1e-2);
        EXPECT_GT(maxRelativeDifference(in(0), hostsAlone.radiance), 1e-2);
    }
}

TEST_F(LightLayers, BeyondTheLastAreNamed)
{
    const auto own = createLighting(g_, 1);
    const Images images = uploadImages(g_);
    CndError error{};
    CndLight light = randomSpheres(g_, 1, 1)[0];
    light.layers = 1u << CND_LAYER_COUNT;
    const CndLightSet set{sizeof set, 1, &light, {}, nullptr};
    EXPECT_EQ(cndSetLights(own.lighting, &set, &error), CND_ERROR_INVALID_ARGUMENT);
    EXPECT_STREQ(error.message, "CndLightSet: lights[0]: layers has bits beyond CND_LAYER_COUNT");
    const CndLightingFrame frame = frameOf(g_, images, {.layers = 1u << CND_LAYER_COUNT});
    expectRefused(own.view, frame, "CndLightingFrame: layers has bits beyond CND_LAYER_COUNT");
}

} // namespace
} // namespace candelabra::test
