// SPDX-License-Identifier: Apache-2.0
// Tests how the evaluated pairs of a frame are shared out among its lights.
// gpu/test_light_costs.cpp tests what is drawn for that, and that the sums are the engine's.
#include <algorithm>
#include <numeric>

#include <gtest/gtest.h>

#include "measure/frame/light_costs.h"

namespace candelabra::test
{

namespace
{

using namespace candelabra::app;

constexpr uint32_t side = 16; // pixels: four tiles

// Returns the pair image of a floor, one metre per pixel, 3 pairs per pixel; the right column shows
// nothing.
PairImage floorImage()
{
    return {.size = {side, side},
            .evaluated = std::vector<float>(side * side, 3.0f),
            .pointAt = [](uint32_t x, uint32_t y) {
                return x + 1 < side ? std::optional(reference::SurfacePoint{
                                          .position = {x + 0.5, 0, y + 0.5}})
                                    : std::nullopt;
            }};
}

CndLight lampAt(float x, float z, uint32_t layers = 0)
{
    return {
        .type = CND_LIGHT_POINT, .position = {x, 0.1f, z}, .influenceRadius = 3, .layers = layers};
}

double sumOfPairs(const LightCosts& costs)
{
    return std::accumulate(costs.lights.begin(), costs.lights.end(), costs.others,
                           [](double sum, const LightCost& l) { return sum + l.pairs; });
}

} // namespace

TEST(LightCosts, AreSharedByThePixelsThatLightsCover)
{
    CndLight spot = lampAt(4, 4); // points straight down, so it lights only what is below it
    spot.type = CND_LIGHT_SPOT;
    spot.direction[1] = -1;
    spot.outerConeAngle = 0.1f;
    CndLight sun{.type = CND_LIGHT_DIRECTIONAL, .direction = {0, -1, 0}};
    CndLight below = lampAt(4, 4);
    below.position[1] = -1;
    const LightCosts costs = shareOut(floorImage(), {below, lampAt(4, 4), spot, sun}, {}, {});
    EXPECT_EQ(costs.surfaces, side * (side - 1));
    EXPECT_EQ(costs.pairs, 3.0 * side * side);
    EXPECT_EQ(costs.others, 0);
    ASSERT_EQ(costs.lights.size(), 2u); // the spot covers no pixel centre
    EXPECT_EQ(costs.lights[0].light, 3u);
    EXPECT_EQ(costs.lights[0].pixels, costs.surfaces);
    EXPECT_EQ(costs.lights[1].light, 1u);
    // 32 pixel centres on a grid of 1 m are within 3 m of (4, 4).
    EXPECT_EQ(costs.lights[1].pixels, 32u);
    EXPECT_EQ(costs.coveredPairs, costs.surfaces + 32);
    EXPECT_DOUBLE_EQ(costs.lights[1].pairs, 3.0 * 64 * 32 / (64 + 32)); // its share of its tile's
                                                                        // pairs
    EXPECT_DOUBLE_EQ(sumOfPairs(costs), costs.pairs);
}

// Such lights are in no list, and pixels that they would cover are not attributed to them.
TEST(LightCosts, LightsOfOtherLayersCostNothing)
{
    const std::vector<CndLight> lights = {lampAt(4, 4, 1), lampAt(5, 5, 2), lampAt(12, 4, 2),
                                          lampAt(4, 12, 6), lampAt(12, 12)};
    const auto listed = [&](uint32_t layers) {
        Camera camera;
        camera.layers = layers;
        const LightCosts costs = shareOut(floorImage(), lights, {}, camera);
        EXPECT_DOUBLE_EQ(sumOfPairs(costs), costs.pairs);
        std::vector<uint32_t> out;
        for (const LightCost& light : costs.lights)
            out.push_back(light.light);
        std::sort(out.begin(), out.end());
        return out;
    };
    using Lights = std::vector<uint32_t>;
    EXPECT_EQ(listed(0), (Lights{0, 1, 2, 3, 4}));
    EXPECT_EQ(listed(1), (Lights{0, 4}));
    EXPECT_EQ(listed(2), (Lights{1, 2, 3, 4}));
    EXPECT_EQ(listed(4), (Lights{3, 4}));
    EXPECT_EQ(listed(8), (Lights{4}));
    Camera camera;
    camera.layers = 1;
    const LightCosts costs = shareOut(floorImage(), lights, {}, camera);
    EXPECT_EQ(costs.others, 3.0 * 64 * 2);             // tiles whose lights are hidden
    EXPECT_DOUBLE_EQ(costs.lights[0].pairs, 3.0 * 64); // alone in its tile
    const Json json = lightCostJson(costs, {.lights = lights}, 10, 100);
    EXPECT_EQ(json["lightsThatCoverPixels"], 2);
    EXPECT_DOUBLE_EQ(json["tilesWithoutLightMs"].get<double>(), 50);
}

} // namespace candelabra::test
