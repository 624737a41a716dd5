// SPDX-License-Identifier: Apache-2.0
// Shows that the comparison with brute force is able to fail: one light is removed from the list of
// one tile, between culling and shading, and the difference must be noticed. The list is inside the
// module, so a ModuleSpy finds it.
#include "gpu/lighting_harness.h"
#include "gpu/module_spy.h"

#include <algorithm>
#include <limits>

#include "shared/cluster_data.h"

namespace candelabra::test
{

TEST_F(LightingTest, DeletingOneLightFromOneTileIsNoticed)
{
    const CpuGBuffer g = randomGBuffer(64, 64, 5);
    std::vector<CndLight> lights = randomSpheres(g, 50, 5);
    for (CndLight& light : lights) {
        light.radius = 0.1f; // all are alike, so that none is too dim to be noticed
        std::fill_n(light.emission, 3, 1.0f);
        light.influenceRadius = 40; // every tile lists every light ...
        light.position[2] = -1.5f;  // ... and faces them: the nearest wall is 3 m away
    }
    CndLight dark = lights[0];
    dark.emission[0] = dark.emission[1] = dark.emission[2] = 0;
    // With the largest influence and the largest coordinates, this light is the last in the order
    // of lights.
    dark.influenceRadius = std::numeric_limits<float>::infinity();
    dark.position[0] = dark.position[1] = dark.position[2] = 1e6f;
    lights.push_back(dark);

    // Beside a highlight, which decides what the largest radiance is, a light on a wall could be
    // too dim to be noticed. (On an H100 one of eight was, in a tile that happened to have the
    // page.)
    const CndSpecularMethod none = CND_SPECULAR_NONE;
    ModuleSpy spy(deviceDesc());
    const LightingResult brute = run(g, lights, {.specular = none, .culling = CND_CULLING_BRUTE});
    const LightingResult intact = run(g, lights, {.specular = none, .host = &spy.desc()});
    EXPECT_TRUE(agree(intact.radiance, brute.radiance, batchesOnLlvmpipe));

    // Lists are made block by block, then tile by tile, one page each. There are at most 4 blocks
    // of 32x32 pixels and one of 128x128 pixels, with at most 8 slices each, so this page
    // belongs to a tile.
    constexpr uint32_t tilePage = 5 * 8 + 3;
    uint32_t noticed = 0, written = 0;
    for (uint32_t entry = 0; entry < 50; entry += 7) {
        bool done = false; // the pass may have several dispatches
        spy.onPass = [&](VkCommandBuffer cmd, const std::string& pass) {
            if (pass != "shade_tiles" || done)
                return;
            done = true;
            fullBarrier(cmd);
            const uint32_t at = tilePage * gpu::PAGE_WORDS + 1 + entry;
            vkCmdFillBuffer(cmd, spy.buffer("list entries").buffer, at * sizeof(uint32_t),
                            sizeof(uint32_t), uint32_t(lights.size()) - 1);
            fullBarrier(cmd);
            ++written;
        };
        const LightingResult broken = run(g, lights, {.specular = none, .host = &spy.desc()});
        noticed += !agree(broken.radiance, brute.radiance, batchesOnLlvmpipe);
    }
    EXPECT_EQ(written, 8u);
    EXPECT_EQ(noticed, 8u);
}

} // namespace candelabra::test
