// SPDX-License-Identifier: Apache-2.0
// Everything placed by a host's allocator, in shared blocks that hold garbage: the same bits.
#include "candelabra/candelabra.hpp"
#include "gpu/exposure_harness.h"
#include "gpu/lighting_harness.h"
#include "harness/host_allocator.h"

namespace candelabra::test
{
namespace
{

constexpr VkDeviceSize blockBytes = 1 << 22;

std::vector<CndLight> lightsOfAllTypes(const CpuGBuffer& g)
{
    std::vector<CndLight> lights;
    for (uint32_t type = 0; type < CND_LIGHT_TYPE_COUNT; ++type)
        for (const CndLight& light : lightsOf(CndLightType(type), g, 20, type))
            lights.push_back(light);
    return lights;
}

} // namespace

TEST_F(LightingTest, HostsMemoryChangesNothing)
{
    CndCamera camera;
    setPerspective(camera, 1.0, 1.5, 0.1);
    const CpuGBuffer g = randomGBuffer(72, 48, camera, 0, 31);
    const std::vector<CndLight> lights = lightsOfAllTypes(g);
    HostAllocator allocator(deviceDesc(), blockBytes);
    const CndDeviceDesc host = allocator.desc();
    RunOptions options{.specular = CND_SPECULAR_CONIC, .countPairs = true, .frames = 3};
    const LightingResult own = run(g, lights, options);
    options.host = &host;
    // Neither what memory held before nor what a recording left in scratch memory is read.
    int byte = 0xFF; // NaN
    options.beforeFrame = [&] { allocator.fill(CND_MEMORY_SCRATCH, byte--); };
    const LightingResult placed = run(g, lights, options);
    EXPECT_TRUE(sameBits(placed, own));
    EXPECT_EQ(placed.stats.contributingPairs, own.stats.contributingPairs);
    EXPECT_GT(allocator.allocations, 30u);
    EXPECT_TRUE(allocator.live.empty());
    options.culling = CND_CULLING_BRUTE;
    options.countPairs = false;
    EXPECT_LE(maxRelativeDifference(run(g, lights, options).radiance, own.radiance), 1e-5);
}

TEST_F(ExposureTest, HostsMemoryChangesNothing)
{
    const gpu::Image radiance = toDevice(wildPicture(70, 50, 9));
    CndExposureFrame frame = frameOf(radiance, plainSettings());
    const CndExposureStats own = run(frame);
    HostAllocator allocator(deviceDesc(), blockBytes);
    {
        auto exposure = Exposure::create(allocator.desc(), {.framesInFlight = 1});
        ASSERT_TRUE(exposure) << exposure.error().message;
        for (int i = 0; i < 2; ++i) {
            allocator.fill(CND_MEMORY_SCRATCH, 0xFF);
            context().submitAndWait([&](VkCommandBuffer cmd) {
                const auto recorded = exposure.value().record(cmd, frame);
                ASSERT_TRUE(recorded) << recorded.error().message;
            });
            const auto stats = exposure.value().stats(0);
            ASSERT_TRUE(stats && stats.value());
            EXPECT_EQ(std::memcmp(stats.value()->histogram, own.histogram, sizeof own.histogram),
                      0);
            EXPECT_EQ(stats.value()->targetEv100, own.targetEv100);
        }
    }
    EXPECT_TRUE(allocator.live.empty());
}

TEST_F(GpuTest, HostsMemoryHoldsImages)
{
    HostAllocator allocator(deviceDesc(), blockBytes);
    {
        auto environment =
            Environment::create(allocator.desc(), {.framesInFlight = 1,
                                                   .gbufferLayout = CND_GBUFFER_HOST,
                                                   .cubeSize = 64,
                                                   .gbuffer = {.roughness = CND_CHANNEL_NORMAL_A}});
        ASSERT_TRUE(environment) << environment.error().message;
        size_t images = 0;
        for (const auto& [number, placed] : allocator.live)
            images += placed.kind == CND_MEMORY_IMAGE;
        EXPECT_EQ(images, 4u); // three cubes and what stands in for packed normals
    }
    EXPECT_TRUE(allocator.live.empty());
}

} // namespace candelabra::test
