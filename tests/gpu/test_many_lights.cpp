// SPDX-License-Identifier: Apache-2.0
// More lights than the loops of some drivers survive: llvmpipe silently ends every loop of a shader
// invocation after 65535 iterations in total (LP_MAX_TGSI_LOOP_ITERATIONS). Only the last light
// shines, so a walk that loses its end leaves a black image; the expected image has only that
// light.
#include "gpu/lighting_harness.h"
#include "harness/full_tests.h"

#include <limits>

namespace candelabra::test
{

TEST_F(LightingTest, TheLastOfManyLightsIsNotLost)
{
    CndCamera camera;
    setPerspective(camera, 1.0, 1.0, 0.1);
    const CpuGBuffer g = randomGBuffer(24, 16, camera, 0, 5);
    std::vector<uint32_t> counts = {20000, 70000};
    if (fullTests())
        counts.insert(counts.end(), {40000, 300000});
    for (const uint32_t count : counts) {
        std::vector<CndLight> lights = randomSpheres(g, 1, 5);
        // Without a cut, every light is in every list.
        lights[0].influenceRadius = std::numeric_limits<float>::infinity();
        const CndLight bright = lights[0];
        CndLight dark = bright;
        dark.emission[0] = dark.emission[1] = dark.emission[2] = 0;
        const LightingResult expected = run(g, {bright}, {.culling = CND_CULLING_BRUTE});
        lights.assign(count, dark);
        lights.back() = bright;
        for (const CndCulling culling : {CND_CULLING_CLUSTERED, CND_CULLING_BRUTE}) {
            const LightingResult all = run(g, lights, {.culling = culling});
            EXPECT_TRUE(agree(all.radiance, expected.radiance, batchesOnLlvmpipe))
                << count << " lights, culling " << culling;
        }
        // Clusters whose lists do not fit walk the whole light tree.
        const LightingResult unlisted = run(g, lights, {.listBudget = 4096});
        EXPECT_TRUE(agree(unlisted.radiance, expected.radiance, batchesOnLlvmpipe)) << count;
    }
    // The other lights reach so little that no tile lists more than the last light: long masks,
    // short lists.
    const uint32_t count = 1200000;
    std::vector<CndLight> lights = randomSpheres(g, 1, 5);
    lights[0].influenceRadius = std::numeric_limits<float>::infinity();
    const CndLight bright = lights[0];
    CndLight away = bright;
    away.position[2] = 1e4f; // far behind the camera
    away.influenceRadius = 2 * away.radius;
    lights.assign(count, away);
    lights.back() = bright;
    const LightingResult expected = run(g, {bright}, {.culling = CND_CULLING_BRUTE});
    EXPECT_TRUE(agree(run(g, lights).radiance, expected.radiance, batchesOnLlvmpipe));
}

} // namespace candelabra::test
