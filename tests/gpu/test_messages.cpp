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
    log.expect(CND_MESSAGE_WARNING, "clusters have no list");
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

} // namespace candelabra::test
