// SPDX-License-Identifier: Apache-2.0
// A host's allocator places everything in shared blocks that hold garbage: results must have the
// same bits.
#include "candelabra/candelabra.hpp"
#include "gpu/exposure_harness.h"
#include "gpu/lighting_harness.h"
#include "harness/host_allocator.h"

namespace candelabra::test
{
namespace
{

constexpr VkDeviceSize blockBytes = 1 << 22;

// One type with lists and one without.
constexpr CndLightType usedTypes[] = {CND_LIGHT_SPHERE, CND_LIGHT_DIRECTIONAL};

std::vector<CndLight> someLights(const CpuGBuffer& g)
{
    std::vector<CndLight> lights;
    for (const CndLightType type : usedTypes)
        for (const CndLight& light : lightsOf(type, g, 60, type))
            lights.push_back(light);
    return lights;
}

} // namespace

TEST_F(LightingTest, HostsMemoryChangesNothing)
{
    const CpuGBuffer g = randomGBuffer(72, 48, 31);
    const std::vector<CndLight> lights = someLights(g);
    HostAllocator allocator(deviceDesc(), blockBytes);
    const CndDeviceDesc host = allocator.desc();
    for (const CndInfluenceRule rule : {CND_INFLUENCE_GIVEN, CND_INFLUENCE_BY_ERROR}) {
        RunOptions options{.countPairs = true,
                           .influence = {.rule = rule, .maxError = 8.0f / 255, .exposure = 1e-4f},
                           .frames = 3};
        const LightingResult own = run(g, lights, options);
        options.host = &host;
        // Neither earlier contents of memory nor what a recording left in scratch memory may be
        // read.
        int byte = 0xFF; // 0xFF bytes are NaN
        options.beforeFrame = [&] { allocator.fill(CND_MEMORY_SCRATCH, byte--); };
        const LightingResult placed = run(g, lights, options);
        EXPECT_TRUE(sameBits(placed, own)) << rule;
        EXPECT_EQ(placed.stats.contributingPairs, own.stats.contributingPairs) << rule;
        EXPECT_EQ(placed.stats.cutBelow, own.stats.cutBelow) << rule;
        EXPECT_EQ(own.stats.cutBelow > 0, rule == CND_INFLUENCE_BY_ERROR);
    }
    EXPECT_GT(allocator.allocations, 20u);
    EXPECT_TRUE(allocator.live.empty());
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
            auto stats = exposure.value().stats(0);
            ASSERT_TRUE(stats && stats.value());
            EXPECT_EQ(std::memcmp(stats.value()->histogram, own.histogram, sizeof own.histogram),
                      0);
            EXPECT_EQ(stats.value()->targetEv100, own.targetEv100);
        }
    }
    EXPECT_TRUE(allocator.live.empty());
}

// After planning, one block of each kind must be just large enough.
TEST_F(LightingTest, PlannedMemoryIsEnough)
{
    const CpuGBuffer g = randomGBuffer(72, 48, 31);
    const std::vector<CndLight> lights = someLights(g);
    const CndLightingDesc desc{.framesInFlight = 2,
                               .specularMethods = 1u << RunOptions{}.specular,
                               .lightCapacity = uint32_t(lights.size()),
                               .lightTypes = 1u << usedTypes[0] | 1u << usedTypes[1]};
    const CndLightingViewDesc viewDesc{.maxWidth = g.width, .maxHeight = g.height};
    auto planned = Lighting::plan(deviceDesc(), desc, std::array{viewDesc});
    ASSERT_TRUE(planned) << planned.error().message;
    HostAllocator allocator(deviceDesc(), planned.value());
    {
        auto lighting = Lighting::create(allocator.desc(), desc);
        ASSERT_TRUE(lighting) << lighting.error().message;
        auto view = lighting.value().createView(viewDesc);
        ASSERT_TRUE(view) << view.error().message;
        ASSERT_TRUE(lighting.value().setLights(lights, {0, 0, 0}));
        const CndMemoryUsage held = lighting.value().memory().value();
        for (int kind = 0; kind < CND_MEMORY_KIND_COUNT; ++kind) {
            EXPECT_EQ(held.allocations[kind], planned.value().allocations[kind]) << kind;
            EXPECT_EQ(held.bytes[kind], planned.value().bytes[kind]) << kind;
        }
        const Images images = uploadImages(g);
        context().submitAndWait([&](VkCommandBuffer cmd) {
            clearRadiance(cmd, images);
            const auto recorded = view.value().record(cmd, frameOf(g, images, {}));
            ASSERT_TRUE(recorded) << recorded.error().message;
        });
        EXPECT_TRUE(sameBits(readRadiance(images), run(g, lights).radiance));
    }
    EXPECT_TRUE(allocator.live.empty());
}

TEST_F(GpuTest, PlannedMemoryHoldsImages)
{
    const CndEnvironmentDesc desc{.framesInFlight = 1,
                                  .gbufferLayout = CND_GBUFFER_HOST,
                                  .cubeSize = 64,
                                  .gbuffer = {.roughness = CND_CHANNEL_NORMAL_A}};
    auto planned = Environment::plan(deviceDesc(), desc);
    ASSERT_TRUE(planned) << planned.error().message;
    HostAllocator allocator(deviceDesc(), planned.value());
    {
        auto environment = Environment::create(allocator.desc(), desc);
        ASSERT_TRUE(environment) << environment.error().message;
        size_t images = 0;
        for (const auto& [number, placed] : allocator.live)
            images += placed.kind == CND_MEMORY_IMAGE;
        EXPECT_EQ(images, 4u); // three cubes and the placeholder for packed normals
        EXPECT_EQ(environment.value().memory().value().bytes[CND_MEMORY_IMAGE],
                  planned.value().bytes[CND_MEMORY_IMAGE]);
    }
    EXPECT_TRUE(allocator.live.empty());
}

} // namespace candelabra::test
