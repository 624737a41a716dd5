// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>
#include <stdexcept>

#include <gtest/gtest.h>

#include "reference/tone_map.h"
#include "test_reference_support.h"

namespace candelabra::test
{

using namespace candelabra::reference;

namespace
{

// Applies the curve as its authors published it, without the factor for middle grey.
glm::dvec3 published(CndToneMap curve, const glm::dvec3& colour)
{
    return toneMap(curve, colour / middleGreyGain(curve));
}

double grey(CndToneMap curve, double value)
{
    return published(curve, glm::dvec3(value)).g;
}

} // namespace

TEST(ReferenceToneMap, everyCurveStaysInRangeAndRises)
{
    for (int i = 0; i < CND_TONEMAP_COUNT; ++i) {
        const auto curve = static_cast<CndToneMap>(i);
        double previous = 0;
        for (double stops = -16; stops < 20; stops += 0.01) {
            const glm::dvec3 color = toneMap(curve, glm::dvec3(std::exp2(stops)));
            for (int channel = 0; channel < 3; ++channel) {
                ASSERT_GE(color[channel], 0) << i << ' ' << stops;
                ASSERT_LE(color[channel], 1) << i << ' ' << stops;
                // Greys stay grey as far as the rows of the published matrices sum to 1.
                ASSERT_NEAR(color[channel], color.g, 1e-3) << i << ' ' << stops;
            }
            ASSERT_GE(color.g, previous) << i << ' ' << stops;
            previous = color.g;
        }
        EXPECT_GT(previous, 0.97) << i;
    }
}

TEST(ReferenceToneMap, everyCurveDisplaysMiddleGreyAsItself)
{
    for (int i = 0; i < CND_TONEMAP_COUNT; ++i) {
        const auto curve = static_cast<CndToneMap>(i);
        const glm::dvec3 shown = toneMap(curve, glm::dvec3(0.18));
        for (int channel = 0; channel < 3; ++channel)
            EXPECT_NEAR(shown[channel], 0.18, 1e-4) << i;
    }
    EXPECT_NEAR(middleGreyGain(CND_TONEMAP_NONE), 1, 1e-15);
    EXPECT_NEAR(middleGreyGain(CND_TONEMAP_REINHARD), 1 / 0.82, 1e-14);
    EXPECT_NEAR(middleGreyGain(CND_TONEMAP_PBR_NEUTRAL), 0.22 / 0.18, 1e-14);
}

TEST(ReferenceToneMap, badInputsAreDefined)
{
    const double infinite = std::numeric_limits<double>::infinity();
    for (int i = 0; i < CND_TONEMAP_COUNT; ++i) {
        const auto curve = static_cast<CndToneMap>(i);
        EXPECT_EQ(toneMap(curve, glm::dvec3(NAN)), toneMap(curve, glm::dvec3(0))) << i;
        EXPECT_EQ(toneMap(curve, glm::dvec3(-3)), toneMap(curve, glm::dvec3(0))) << i;
        EXPECT_GT(grey(curve, infinite), 0.97) << i;
        EXPECT_LT(grey(curve, 0), 1e-6) << i;
    }
    EXPECT_THROW(toneMap(CND_TONEMAP_COUNT, glm::dvec3(1)), std::invalid_argument);
}

TEST(ReferenceToneMap, noneAndReinhardByHand)
{
    const glm::dvec3 clipped = published(CND_TONEMAP_NONE, {0.25, 1.5, -1});
    EXPECT_NEAR(glm::distance(clipped, glm::dvec3(0.25, 1, 0)), 0, 1e-15);
    const glm::dvec3 reinhard = published(CND_TONEMAP_REINHARD, {1, 3, 0});
    EXPECT_NEAR(glm::distance(reinhard, glm::dvec3(0.5, 0.75, 0)), 0, 1e-15);
}

TEST(ReferenceToneMap, pbrNeutralKeepsBaseColours)
{
    // Below the start of the compression the colour is only shifted by F90 = 0.04 ...
    const glm::dvec3 kept = published(CND_TONEMAP_PBR_NEUTRAL, {0.5, 0.3, 0.1});
    EXPECT_NEAR(glm::distance(kept, glm::dvec3(0.46, 0.26, 0.06)), 0, 1e-15);
    // ... or by less in the toe: 0.04 - 0.04^2 / 0.16 = 0.03 for a minimum of 0.04.
    EXPECT_NEAR(published(CND_TONEMAP_PBR_NEUTRAL, {0.5, 0.3, 0.04}).b, 0.01, 1e-15);
    // A grey peak of 1: p = 0.96, d = 0.24, p' = 1 - 0.0576 / 0.44; desaturation does not affect
    // grey.
    EXPECT_NEAR(grey(CND_TONEMAP_PBR_NEUTRAL, 1), 1 - 0.24 * 0.24 / 0.44, 1e-12);
    // Continuous where the compression starts, at a peak of 0.76 + 0.04.
    EXPECT_NEAR(grey(CND_TONEMAP_PBR_NEUTRAL, 0.8 - 1e-9),
                grey(CND_TONEMAP_PBR_NEUTRAL, 0.8 + 1e-9), 1e-8);
    // A red of 2: p = 2, p' = 1 - 0.0576 / 1.48, desaturated by 0.15 (p - p').
    const double peak = 1 - 0.24 * 0.24 / 1.48, keep = 1 / (0.15 * (2 - peak) + 1);
    const glm::dvec3 red = published(CND_TONEMAP_PBR_NEUTRAL, {2, 0, 0});
    EXPECT_NEAR(red.r, peak, 1e-12);
    EXPECT_NEAR(red.g, peak * (1 - keep), 1e-12);
    // Very bright saturated colours go to white.
    EXPECT_GT(published(CND_TONEMAP_PBR_NEUTRAL, {1e6, 0, 0}).b, 0.99);
}

// For a grey g only the rational fit remains, because the rows of the matrices sum to 1.
TEST(ReferenceToneMap, acesGreyIsTheRationalFit)
{
    WorstCase worst;
    for (const double g : {0.01, 0.18, 0.5, 1.0, 4.0}) {
        const double fit =
            (g * (g + 0.0245786) - 0.000090537) / (g * (0.983729 * g + 0.4329510) + 0.238081);
        worst.add(std::abs(grey(CND_TONEMAP_ACES, g) - fit), "grey", g);
    }
    EXPECT_TRUE(worst.within(2e-5));
    // A pure red bleeds into the other channels through the matrices.
    const glm::dvec3 red = published(CND_TONEMAP_ACES, {4, 0, 0});
    EXPECT_GT(red.r, red.g);
    EXPECT_GT(red.g, 0);
}

TEST(ReferenceToneMap, agxPutsMiddleGreyInTheMiddleOfTheDisplay)
{
    // 0.18 is 10 of 16.5 stops up the log range, where Sobotka's sigmoid has its pivot at 0.5 of
    // the encoded signal.
    EXPECT_NEAR(std::pow(grey(CND_TONEMAP_AGX, 0.18), 1 / 2.2), 0.5, 0.005);
    EXPECT_LT(grey(CND_TONEMAP_AGX, 1e-5), 1e-5);
    const glm::dvec3 red = published(CND_TONEMAP_AGX, {16, 0, 0});
    EXPECT_GT(red.g, 0.1); // saturated highlights are desaturated
    EXPECT_GT(red.r, 1.5 * red.g);
}

TEST(ReferenceToneMap, srgbIsTheExactPiecewiseCurve)
{
    EXPECT_EQ(srgbEncode(0), 0);
    EXPECT_NEAR(srgbEncode(1), 1, 1e-15);
    EXPECT_NEAR(srgbEncode(std::pow((0.5 + 0.055) / 1.055, 2.4)), 0.5, 1e-15);
    EXPECT_DOUBLE_EQ(srgbEncode(0.002), 0.02584);
    EXPECT_NEAR(srgbEncode(0.0031308), srgbEncode(std::nextafter(0.0031308, 1)), 1e-7);
}

} // namespace candelabra::test
