// SPDX-License-Identifier: Apache-2.0
// Tests which lights cost what, and what each contributes to a pixel, against the engine's own
// counts, its image, and the truth.
#include <algorithm>
#include <cmath>
#include <optional>

#include "candelabra/candelabra.hpp"
#include "harness/full_tests.h"
#include "harness/gpu_fixture.h"
#include "load/load.h"
#include "measure/frame/frames.h"
#include "measure/frame/light_costs.h"
#include "measure/frame/pick.h"
#include "render/camera.h"

using namespace candelabra;
using namespace candelabra::app;

namespace
{

class LightCostsTest : public test::GpuTest
{
protected:
    static FrameOptions frameOf(const Scene& scene)
    {
        return {.camera = selectCamera(scene, ""),
                .lightsVisible = scene.lightsVisible,
                .exposure = defaultExposureSettings()};
    }
};

} // namespace

TEST_F(LightCostsTest, AddUpToWhatTheEngineCounts)
{
    const Scene scene = loadScene("hall", {.lights = 400});
    Renderer renderer(context(), scene,
                      {.size = {200, 112}, .specularMethods = 1u << CND_SPECULAR_CONIC});
    const FrameOptions frame = frameOf(scene);
    const LightCosts costs = lightCosts(context(), renderer, scene, frame);
    const CndLightingStats stats = countPairs(context(), renderer, frame);
    // The statistics also count lanes whose pixel has no surface, while they wait for others.
    EXPECT_LE(costs.pairs, double(stats.evaluatedPairs));
    EXPECT_GE(costs.pairs, 0.99 * double(stats.evaluatedPairs));
    uint64_t covered = 0;
    double sum = 0;
    for (const LightCost& light : costs.lights) {
        covered += light.pixels;
        sum += light.pairs;
    }
    EXPECT_EQ(covered, costs.coveredPairs);
    // Two ways to count the same pairs: the device's lists, and every light against the G-buffer.
    EXPECT_NEAR(double(covered), double(stats.contributingPairs),
                0.002 * double(stats.contributingPairs));
    EXPECT_NEAR(sum + costs.others, costs.pairs, 1e-6 * costs.pairs);
    EXPECT_GE(sum, 0.95 * costs.pairs); // hardly any tile waits without a contributing light
    ASSERT_GE(costs.lights.size(), 100u);
    EXPECT_GE(costs.lights[0].pairs, costs.lights[1].pairs);

    const Json json = lightCostJson(costs, scene, 20, 100);
    double ms = 0;
    const Json all = lightCostJson(costs, scene, 400, 100);
    for (const auto& light : all["lights"])
        ms += light["ms"].get<double>();
    EXPECT_NEAR(ms, 100, 5);
    EXPECT_EQ(json["lights"].size(), 20u);

    // Without the most expensive light, about its number of pairs fewer are evaluated.
    Scene without = scene;
    without.lights.erase(without.lights.begin() + costs.lights[0].light);
    Renderer other(context(), without,
                   {.size = {200, 112}, .specularMethods = 1u << CND_SPECULAR_CONIC});
    const double saved =
        costs.pairs - double(countPairs(context(), other, frameOf(without)).evaluatedPairs);
    std::cout << "the costliest of 400 lights: " << costs.lights[0].pairs << " of " << costs.pairs
              << " pairs; without it " << saved << " fewer\n";
    EXPECT_GT(saved, 0.5 * costs.lights[0].pairs);
    EXPECT_LT(saved, 2 * costs.lights[0].pairs);
}

TEST_F(LightCostsTest, LightsOfAPixelAddUpToIt)
{
    struct Case {
        const char* scene;
        std::optional<uint32_t> lights;
        CndGBufferLayout layout;
    };
    // COMPACT stores surfaces coarsely; both sides of the comparison use what it stores.
    for (const Case& c : {Case{"hall", 200, CND_GBUFFER_FULL},
                          {"showcase", std::nullopt, CND_GBUFFER_FULL},
                          {"hall", 200, CND_GBUFFER_COMPACT}}) {
        const Scene scene = loadScene(c.scene, {.lights = c.lights});
        Renderer renderer(context(), scene,
                          {.size = {128, 72},
                           .gbufferLayout = c.layout,
                           .specularMethods = 1u << CND_SPECULAR_CONIC});
        size_t lights = 0;
        double worst = 0;
        std::vector<PixelPosition> pixels{{64, 50}, {20, 60}};
        if (test::fullTests())
            pixels.insert(pixels.end(), {{100, 66}, {64, 36}});
        for (const PixelPosition pixel : pixels) {
            const Pick pick = pickPixel(context(), renderer, scene, frameOf(scene), pixel);
            const glm::dvec3 sum = pick.sum();
            for (int channel = 0; channel < 3; ++channel)
                EXPECT_NEAR(sum[channel], pick.radiance[channel],
                            1e-6 * std::max(pick.radiance[channel], 1e-6))
                    << c.scene << " " << pixel.x << "," << pixel.y;
            lights += pick.lights.size();
            for (const PickedLight& light : pick.lights)
                // Tubes, rectangles and discs have a fitted lobe, whose error is large in places
                // (see the limits in README).
                if (light.radiance.y > 0.01 * pick.radiance.y &&
                    scene.lights[light.light].type < CND_LIGHT_TUBE)
                    worst = std::max(worst, std::abs(light.radiance.y / light.truth.y - 1));
        }
        std::cout << c.scene << ": " << lights << " lights at four pixels, error to truth up to "
                  << 100 * worst << "%\n";
        EXPECT_GE(lights, 4u) << c.scene;
        EXPECT_LT(worst, 0.05) << c.scene; // for lights that contribute at least a hundredth
    }
}
