// SPDX-License-Identifier: Apache-2.0
// Tests which messages reading the statistics sends to the host, once each.
#include "candelabra/candelabra.hpp"
#include "gpu/lighting_harness.h"
#include "harness/host_log.h"

namespace candelabra::test
{

TEST_F(LightingTest, ListsWithoutRoomAndRejectedLightsAreToldOnce)
{
    const CpuGBuffer g = randomGBuffer(48, 32, 12);
    const std::vector<CndLight> lights = randomSpheres(g, 200, 12);
    // without a radius they are invalid
    const gpu::Buffer particles = upload("particles", std::vector<CndDeviceLight>(3));
    const CndDeviceLights device{
        .type = CND_LIGHT_SPHERE, .maxCount = 3, .buffer = particles.get(), .influenceRadius = 1};
    HostLog log;
    auto lighting = Lighting::create(log.desc(deviceDesc()),
                                     {.framesInFlight = 1, .lightTypes = 1u << CND_LIGHT_SPHERE});
    ASSERT_TRUE(lighting) << lighting.error().message;
    auto view = lighting.value().createView({.maxWidth = 48, .maxHeight = 32, .listBudget = 1});
    ASSERT_TRUE(view) << view.error().message;
    const Images images = uploadImages(g);
    log.messages.clear();
    const auto draw = [&] {
        context().submitAndWait([&](VkCommandBuffer cmd) {
            const auto recorded =
                view.value().record(cmd, frameOf(g, images, {.specular = CND_SPECULAR_CONIC}));
            ASSERT_TRUE(recorded) << recorded.error().message;
        });
        ASSERT_TRUE(view.value().stats(0));
        ASSERT_TRUE(view.value().stats(0));
    };
    ASSERT_TRUE(lighting.value().setLights(lights, {0, 0, 0}));
    log.expectNone();
    draw();
    log.expect(CND_MESSAGE_WARNING,
               "clusters have no list, because CndLightingViewDesc::listBudget, "
               "1 bytes, was used up, and ");
    draw();
    log.expectNone();
    for (int i = 0; i < 2; ++i) { // once for each set
        CndLightSet set{.count = 200, .lights = lights.data(), .deviceLights = &device};
        ASSERT_TRUE(lighting.value().setLights(set));
        draw();
        log.expect(CND_MESSAGE_WARNING, "3 lights of CndDeviceLights give no light");
        draw();
        log.expectNone();
    }
}

TEST_F(LightingTest, TheBudgetThatRanOutIsTold)
{
    const CpuGBuffer g = randomGBuffer(48, 32, 12);
    HostLog log;
    auto lighting = Lighting::create(
        log.desc(deviceDesc()),
        {.framesInFlight = 1, .lightTypes = 1u << CND_LIGHT_SPHERE, .shadows = {.points = 32}});
    ASSERT_TRUE(lighting) << lighting.error().message;
    const float triangle[] = {0, 0, -1, 1, 0, -1, 0, 1, -1};
    auto mesh = lighting.value().addOccluderMesh(
        {.positions = triangle, .vertexCount = 3, .triangleCount = 1});
    ASSERT_TRUE(mesh) << mesh.error().message;
    ASSERT_TRUE(lighting.value().addOccluder(
        {.mesh = mesh.value(), .worldFromMesh = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}}));
    ASSERT_TRUE(lighting.value().setLights(randomSpheres(g, 200, 12), {0, 0, 0}));
    const Images images = uploadImages(g);
    log.messages.clear();
    const auto statsWith = [&](VkDeviceSize listBudget, VkDeviceSize shadowBudget) {
        auto view = lighting.value().createView({.maxWidth = 48,
                                                 .maxHeight = 32,
                                                 .listBudget = listBudget,
                                                 .shadowBudget = shadowBudget});
        EXPECT_TRUE(view) << view.error().message;
        context().submitAndWait([&](VkCommandBuffer cmd) {
            EXPECT_TRUE(
                view.value().record(cmd, frameOf(g, images, {.specular = CND_SPECULAR_CONIC})));
        });
        return view.value().stats(0).value().value();
    };
    constexpr VkDeviceSize slot = 256, few = 16 * slot;
    const CndLightingStats short_ = statsWith(0, few);
    const VkDeviceSize enough = (short_.shadowSlots + short_.missingShadowSlots) * slot;
    log.expect(
        CND_MESSAGE_WARNING,
        "no list, because CndLightingViewDesc::shadowBudget, 4096 bytes, was used up, and about " +
            std::to_string(enough) + " would do: they walk");
    const CndLightingStats whole = statsWith(0, enough);
    log.expectNone();
    EXPECT_LE(whole.shadowSlots * slot, enough);
    EXPECT_EQ(whole.missingShadowSlots, 0u);
    EXPECT_EQ(whole.missingListBytes, 0u);
    // Lists that were not made would need more room.
    VkDeviceSize lists = 6144;
    CndLightingStats both = statsWith(lists, slot);
    EXPECT_LT((both.shadowSlots + both.missingShadowSlots) * slot, enough);
    ASSERT_EQ(log.messages.size(), 2u);
    EXPECT_NE(log.messages[0].sentence.find("listBudget, 6144 bytes, was used up, and about " +
                                            std::to_string(lists + both.missingListBytes) +
                                            " would do: "),
              std::string::npos)
        << log.messages[0].sentence;
    EXPECT_NE(log.messages[1].sentence.find("shadowBudget, 256 bytes, was used up: "),
              std::string::npos);
    // Lists of blocks come first, then those of tiles.
    for (int tries = 0; tries < 2 && both.missingListBytes; ++tries) {
        lists += both.missingListBytes;
        both = statsWith(lists, slot);
    }
    EXPECT_EQ(both.missingListBytes, 0u);
    // Both are estimates: which lights they have searched depends on the order of the groups.
    const double estimate = both.shadowSlots + both.missingShadowSlots;
    const double slots = double(enough / slot);
    EXPECT_NEAR(estimate, slots, .05 * slots);
    EXPECT_EQ(statsWith(0, enough + enough / 20).missingShadowSlots, 0u);
}

} // namespace candelabra::test
