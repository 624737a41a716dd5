// SPDX-License-Identifier: Apache-2.0
// Tests the estimate of what shadows take on a CPU.
#include <gtest/gtest.h>

#include "generate/generators.h"
#include "generate/shadow_cost.h"

using namespace candelabra::app;

namespace
{

double cost(const Scene& scene, PixelSize size, bool uncut = false)
{
    return shadowCpuSeconds(scene, scene.cameras[0], size, uncut);
}

} // namespace

// The times were measured with llvmpipe (DECISIONS 86).
TEST(ShadowCost, IsWithinTwoTimesOfWhatWasMeasured)
{
    const struct {
        const char* scene;
        SceneOptions options;
        PixelSize size;
        double measured;
    } frames[] = {{"rooms", {.lights = 4000}, {640, 360}, 0.24},
                  {"rooms", {.lights = 1500, .overlaps = 17.0}, {1280, 720}, 1.1},
                  {"rooms", {.lights = 1500, .overlaps = 79.0}, {1280, 720}, 2.4},
                  {"field", {.lights = 4000}, {640, 360}, 2.7},
                  {"fence", {.lights = 4000}, {640, 360}, 4.2},
                  {"fence", {.lights = 4000}, {1280, 720}, 10.3},
                  {"showcase", {}, {640, 360}, 12.3},
                  {"hall", {.lights = 4000}, {320, 180}, 7.5},
                  {"hall", {.lights = 4000}, {1280, 720}, 81}};
    for (const auto& f : frames) {
        const double estimate = cost(generateScene(f.scene, f.options), f.size);
        EXPECT_GT(estimate, f.measured / 2) << f.scene;
        EXPECT_LT(estimate, f.measured * 2) << f.scene;
    }
}

TEST(ShadowCost, FollowsLightsAndPixels)
{
    Scene scene = generateScene("rooms", {.lights = 1000});
    const PixelSize size{320, 180};
    const double some = cost(scene, size);
    EXPECT_EQ(some, cost(scene, size));
    EXPECT_GT(some, 0);
    EXPECT_GT(cost(scene, {640, 360}), 1.5 * some);
    EXPECT_GT(cost(scene, size, true), some);
    for (CndLight& light : scene.lights)
        light.unshadowed = 1;
    EXPECT_EQ(cost(scene, size), 0);
    scene.lights.clear();
    EXPECT_EQ(cost(scene, size), 0);
    EXPECT_EQ(cost(Scene{.cameras = {Camera{}}}, size), 0);
}

TEST(ShadowCost, IsSaidWithTheOption)
{
    EXPECT_EQ(shadowsLeftOutText(12.4), "shadows are off, because a picture would take about 12 s "
                                        "longer on this CPU; --shadows 64 turns them on");
    EXPECT_NE(shadowsLeftOutText(2.04).find("about 2.0 s"), std::string::npos);
}
