// SPDX-License-Identifier: Apache-2.0
// Lists of more lights than gpu::SHARED_FROM, whose parts are shaded by different groups.
#include "gpu/gpu_like_device.h"
#include "gpu/lighting_harness.h"
#include "gpu/two_classes.h"
#include "harness/full_tests.h"
#include "shared/cluster_data.h"

#include <algorithm>
#include <limits>

namespace candelabra::test
{
namespace
{

// Lights that reach every surface.
std::vector<CndLight> uncut(std::vector<CndLight> lights)
{
    for (CndLight& light : lights)
        light.influenceRadius = std::numeric_limits<float>::infinity();
    return lights;
}

class SharedLists : public LightingTest
{
protected:
    // Expects the light of brute force, with the same bits in all runs and in frames that keep
    // their lists.
    void expectLight(const CpuGBuffer& g, const std::vector<CndLight>& lights, RunOptions options)
    {
        RunOptions brute = options;
        brute.culling = CND_CULLING_BRUTE;
        const LightingResult expected = run(g, lights, brute), first = run(g, lights, options);
        EXPECT_GT(first.stats.maxListLength, gpu::SHARED_FROM);
        EXPECT_EQ(first.stats.unlistedClusters, 0u);
        EXPECT_TRUE(agree(first.radiance, expected.radiance, batchesOnLlvmpipe));
        EXPECT_TRUE(sameBits(run(g, lights, options), first));
        options.frames = 3;
        options.unchanged = true;
        EXPECT_TRUE(sameBits(run(g, lights, options), first));
        options.countPairs = true;
        const CndLightingStats counted = run(g, lights, options).stats;
        EXPECT_GE(counted.listedPairs, counted.maxListLength);
    }
    const CpuGBuffer surfaces = randomGBuffer(24, 16, 5);
};

} // namespace

TEST_F(SharedLists, HoldAllTheirLight)
{
    const CndDeviceDesc gpu = gpuLike(deviceDesc());
    RunOptions byGroups;
    byGroups.host = &gpu;
    byGroups.lighting = createFor(byGroups);
    for (uint32_t type = 0; type < CND_LIGHT_TYPE_COUNT; ++type) {
        if (type == CND_LIGHT_DIRECTIONAL || type == CND_LIGHT_DISTANT_SPHERE)
            continue; // they are in no list
        if (!fullTests() && type != CND_LIGHT_SPHERE && type != CND_LIGHT_RECTANGLE)
            continue;
        SCOPED_TRACE(type);
        const auto lights = uncut(lightsOf(CndLightType(type), surfaces, 2000, type + 1));
        expectLight(surfaces, lights, byGroups);
        // A part of tubes, discs or polygons is too long for a loop of llvmpipe.
        if (type == CND_LIGHT_SPHERE || type == CND_LIGHT_POINT || type == CND_LIGHT_SPOT ||
            type == CND_LIGHT_RECTANGLE)
            expectLight(surfaces, lights, {});
    }
    cndDestroyLighting(byGroups.lighting);
}

TEST_F(SharedLists, MayBeOfBothClasses)
{
    const CpuGBuffer g = twoClasses(48, 16);
    expectLight(g, uncut(randomSpheres(g, 1500, 3)), {.diffuseOnlyTiles = true});
}

TEST_F(SharedLists, OneGroupWalksAsManyLightsAsBefore)
{
    auto lights = uncut(randomSpheres(surfaces, gpu::SHARED_FROM, 3));
    const LightingResult brute = run(surfaces, lights, {.culling = CND_CULLING_BRUTE});
    EXPECT_TRUE(agree(run(surfaces, lights).radiance, brute.radiance));
}

// A loop of llvmpipe walks 12,287 spheres at most.
TEST_F(SharedLists, MayHaveMoreLightsThanALoopWalks)
{
    const CpuGBuffer tile = randomGBuffer(8, 8, 5);
    auto lights = uncut(randomSpheres(tile, 20000, 3));
    for (CndLight& light : lights) // In front of the surfaces, all parts of the list have light.
        light.position[2] = std::max(light.position[2], -2.5f);
    const LightingResult brute = run(tile, lights, {.culling = CND_CULLING_BRUTE});
    const LightingResult listed = run(tile, lights, {.countPairs = true});
    EXPECT_EQ(listed.stats.unlistedClusters, 0u);
    EXPECT_GT(listed.stats.listedPairs, 0u);
    EXPECT_EQ(listed.stats.listedPairs % lights.size(), 0u); // each surface has all lights
    // So many terms are rounded differently in other groups.
    EXPECT_TRUE(agree(listed.radiance, brute.radiance, 1e-5));
}

TEST_F(SharedLists, ALackOfRoomLosesNothing)
{
    const CpuGBuffer tile = randomGBuffer(8, 8, 5);
    const auto lights = uncut(randomSpheres(tile, 2000, 3));
    const LightingResult brute = run(tile, lights, {.culling = CND_CULLING_BRUTE});
    uint32_t unlisted = 0, whole = 0, shared = 0;
    for (uint32_t pages = 8; pages < 160; pages += 8) {
        const LightingResult few =
            run(tile, lights, {.listBudget = pages * gpu::PAGE_WORDS * sizeof(uint32_t)});
        EXPECT_TRUE(agree(few.radiance, brute.radiance, batchesOnLlvmpipe)) << pages;
        const bool asBrute = sameBits(few, brute);
        if (asBrute) {
            EXPECT_GT(few.stats.missingListBytes, 0u) << pages;
        }
        ++(few.stats.unlistedClusters ? unlisted : asBrute ? whole : shared);
    }
    EXPECT_GT(unlisted, 0u);
    EXPECT_GT(shared, 0u);
    if (device().lanesAreCpuVector) { // elsewhere brute force has other bits than a list
        EXPECT_GT(whole, 0u);
    }
}

} // namespace candelabra::test
