// SPDX-License-Identifier: Apache-2.0
// Tests the colours of heat maps.
#include <cmath>

#include <gtest/gtest.h>

#include "render/legend.h"

using namespace candelabra::app;

namespace
{

// Returns CIE L*, 0..100.
double lightness(glm::vec3 srgb)
{
    const auto linear = [](double c) {
        return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
    };
    const double y = 0.2126 * linear(double(srgb.x)) + 0.7152 * linear(double(srgb.y)) +
                     0.0722 * linear(double(srgb.z));
    return y > 0.008856 ? 116 * std::cbrt(y) - 16 : 903.3 * y;
}

} // namespace

TEST(Legend, ColoursRiseEvenlyInLightness)
{
    constexpr int steps = 32;
    const double first = lightness(viridis(0)), last = lightness(viridis(1));
    EXPECT_GT(last - first, 70);
    for (int i = 0; i <= steps; ++i) {
        const double even = first + (last - first) * i / steps;
        EXPECT_NEAR(lightness(viridis(float(i) / steps)), even, 4) << i;
    }
}

TEST(Legend, BarShowsEveryColourInOrder)
{
    const Legend legend = barLegend("lights", {{0, "0"}, {1, "1000"}}, 2);
    ASSERT_EQ(legend.pixels.size(), size_t(legend.width) * legend.height);
    // One row must go from the first colour to the last.
    bool found = false;
    for (uint32_t y = 0; y < legend.height && !found; ++y) {
        const auto row = legend.pixels.begin() + long(y) * legend.width;
        const auto from = std::find(row, row + legend.width, packed(viridis(0)));
        const auto to = std::find(row, row + legend.width, packed(viridis(1)));
        found = from < to && to != row + legend.width;
    }
    EXPECT_TRUE(found);
}
