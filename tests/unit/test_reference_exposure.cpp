// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include "harness/constants.h"
#include "reference/eye_adaptation.h"
#include "test_reference_support.h"

namespace candelabra::test
{

using namespace candelabra::reference;

namespace
{

constexpr float inf = std::numeric_limits<float>::infinity();

CndExposureSettings automatic()
{
    CndExposureSettings settings{};
    settings.middleGrey = 0.18f;
    settings.minEv100 = -6;
    settings.maxEv100 = 18;
    settings.lowPercentile = 0.1f;
    settings.highPercentile = 0.9f;
    settings.speedUp = 3;
    settings.speedDown = 1;
    return settings;
}

std::vector<float> greyImage(const std::vector<float>& values)
{
    std::vector<float> rgba;
    for (const float value : values)
        rgba.insert(rgba.end(), {value, value, value, 1});
    return rgba;
}

Histogram average(const std::vector<float>& values)
{
    return buildHistogram(greyImage(values), static_cast<uint32_t>(values.size()), 1,
                          CND_METERING_AVERAGE);
}

double targetEv(const std::vector<float>& values, double previous = 0)
{
    return adapt(average(values), automatic(), previous, 0, true).targetEv100;
}

uint64_t total(const Histogram& histogram)
{
    return std::accumulate(histogram.counts.begin(), histogram.counts.end(), uint64_t{0});
}

} // namespace

TEST(ReferenceHistogram, binsCheckedByHand)
{
    EXPECT_EQ(histogramBin(0.0f), 0u);
    EXPECT_EQ(histogramBin(-5.0f), 0u);
    EXPECT_EQ(histogramBin(-inf), 0u);
    EXPECT_EQ(histogramBin(std::numeric_limits<float>::denorm_min()), 0u);
    EXPECT_EQ(histogramBin(std::nextafter(0x1p-12f, 0.0f)), 0u);
    EXPECT_EQ(histogramBin(0x1p-12f), 0u);
    EXPECT_EQ(histogramBin(0x1.2p-12f), 1u); // 1 + 1/8
    EXPECT_EQ(histogramBin(0x1p-11f), 8u);
    EXPECT_EQ(histogramBin(std::nextafter(1.0f, 0.0f)), 95u);
    EXPECT_EQ(histogramBin(1.0f), 96u); // 12 octaves of 8 bins each
    EXPECT_EQ(histogramBin(1.5f), 100u);
    EXPECT_EQ(histogramBin(std::nextafter(0x1p20f, 0.0f)), 255u);
    EXPECT_EQ(histogramBin(0x1.cp19f), 254u);
    EXPECT_EQ(histogramBin(std::nextafter(0x1.ep19f, 0.0f)), 254u);
    EXPECT_EQ(histogramBin(0x1p20f), 255u);
    EXPECT_EQ(histogramBin(inf), 255u);
    EXPECT_EQ(histogramBin(nan), std::nullopt);
    EXPECT_EQ(histogramBin(-nan), std::nullopt);
}

// Every edge 2^e (1 + k/8) is the first value of its bin and ends the bin before; the middle is
// inside.
TEST(ReferenceHistogram, edgesAreExactFloats)
{
    for (int bin = 1; bin < CND_HISTOGRAM_BINS; ++bin) {
        const float edge = std::ldexp(1.0f + static_cast<float>(bin % 8) / 8.0f, bin / 8 - 12);
        ASSERT_EQ(histogramBin(edge), static_cast<uint32_t>(bin));
        ASSERT_EQ(histogramBin(std::nextafter(edge, 0.0f)), static_cast<uint32_t>(bin - 1));
        ASSERT_EQ(binFraction(edge), 0u);
        ASSERT_EQ(binFraction(std::nextafter(edge, 0.0f)), 15u);
        for (const double fraction : {0.0, 7.5, 15.0}) {
            const double inside = std::exp2(binLog2Luminance(static_cast<uint32_t>(bin), fraction));
            ASSERT_EQ(histogramBin(static_cast<float>(inside)), static_cast<uint32_t>(bin));
        }
    }
    // 7.5 sixteenths plus half a sixteenth is the middle of the bin.
    EXPECT_NEAR(binLog2Luminance(96, 7.5), std::log2(1 + 0.5 / 8), 1e-15);
    EXPECT_EQ(binFraction(0), 0u);
    EXPECT_EQ(binFraction(inf), 15u);
    EXPECT_EQ(binFraction(1 + 3.0f / 128), 3u);
}

TEST(ReferenceHistogram, luminanceIsRoundedAfterEveryOperation)
{
    EXPECT_EQ(histogramLuminance(1, 0, 0), 0.2126f);
    EXPECT_EQ(histogramLuminance(0, 1, 0), 0.7152f);
    EXPECT_EQ(histogramLuminance(0, 0, 1), 0.0722f);
    // Some of these colours distinguish this order and rounding from any other way to sum.
    int fused = 0, otherOrder = 0;
    for (int i = 1; i < 200; ++i) {
        const float x = static_cast<float>(i);
        const float r = x * 0.37f, g = x * 1.13f, b = x * 2.71f;
        const float red = 0.2126f * r, green = 0.7152f * g, blue = 0.0722f * b;
        // A sum of two floats is exact enough in double precision to be rounded only once.
        const auto sum = [](double left, double right) { return static_cast<float>(left + right); };
        ASSERT_EQ(histogramLuminance(r, g, b), sum(sum(red, green), blue));
        fused += histogramLuminance(r, g, 0) != std::fma(0.7152f, g, red);
        otherOrder += sum(sum(red, green), blue) != sum(red, sum(green, blue));
    }
    EXPECT_GT(fused, 0);
    EXPECT_GT(otherOrder, 0);
    EXPECT_TRUE(std::isnan(histogramLuminance(inf, -inf, 0)));
    EXPECT_TRUE(std::isnan(histogramLuminance(0, nan, 0)));
    EXPECT_EQ(histogramLuminance(inf, 1, 1), inf);
}

TEST(ReferenceHistogram, invalidPixelsAreCountedAndLeftOut)
{
    const Histogram histogram = average({1, nan, 1, -inf, inf, nan});
    EXPECT_EQ(histogram.invalidPixels, 2u);
    EXPECT_EQ(total(histogram), 4u);
    // 0.2126 + 0.7152 + 0.0722 in float32 may round to either side of 1.
    const uint32_t bin = *histogramBin(histogramLuminance(1, 1, 1));
    EXPECT_EQ(histogram.counts[bin], 2u);
    EXPECT_EQ(histogram.counts[0], 1u);
    EXPECT_EQ(histogram.counts[255], 1u);
}

TEST(ReferenceHistogram, centreWeightsFallFromTheCentre)
{
    EXPECT_EQ(centreWeight(0, 0, 1, 1), 15u);
    EXPECT_EQ(centreWeight(1, 1, 3, 3), 15u);
    EXPECT_EQ(centreWeight(0, 1, 3, 3), 15u - 10u); // 15 * 2/3 = 10
    EXPECT_EQ(centreWeight(0, 0, 2, 2), 15u - 7u);  // 15 * 1/2 = 7.5
    EXPECT_EQ(centreWeight(0, 0, 16384, 16384), 1u);
    EXPECT_EQ(centreWeight(8192, 8192, 16384, 16384), 15u);
    for (uint32_t x = 0; x < 1921; ++x) {
        const uint32_t weight = centreWeight(x, 540, 1921, 1081);
        ASSERT_GE(weight, 1u);
        ASSERT_EQ(weight, centreWeight(1920 - x, 540, 1921, 1081));
        // The formula as the shader evaluates it in 32 bits.
        const uint32_t dx = x < 960 ? 1920 - 2 * x : 2 * x - 1920;
        ASSERT_EQ(weight, 15 - std::min(14u, 15u * dx * 1081u / (1921u * 1081u)));
    }
}

TEST(ReferenceHistogram, maskIsStretchedOverTheFrame)
{
    const std::vector<uint8_t> weights = {0, 15, 7, 1};
    const ExposureMask mask{weights, 2, 2};
    EXPECT_EQ(maskWeight(mask, 0, 0, 5, 3), 0u);
    EXPECT_EQ(maskWeight(mask, 2, 0, 5, 3), 0u); // 2*2/5 = 0
    EXPECT_EQ(maskWeight(mask, 3, 1, 5, 3), 15u);
    EXPECT_EQ(maskWeight(mask, 2, 2, 5, 3), 7u);
    EXPECT_EQ(maskWeight(mask, 4, 2, 5, 3), 1u);
    const Histogram histogram =
        buildHistogram(greyImage({4, 8, 16, nan}), 2, 2, CND_METERING_MASK, mask);
    EXPECT_EQ(total(histogram), 15u + 7u);
    EXPECT_EQ(histogram.invalidPixels, 1u);
    EXPECT_THROW(buildHistogram(greyImage({1}), 1, 1, CND_METERING_MASK), std::invalid_argument);
    EXPECT_THROW(buildHistogram(greyImage({1}), 2, 1, CND_METERING_AVERAGE), std::invalid_argument);
}

TEST(ReferenceExposure, percentilesCutFractionsOfBins)
{
    Histogram histogram;
    histogram.counts[10] = 4;
    histogram.counts[20] = 4;
    histogram.counts[200] = 2;
    histogram.fractions[20] = 4 * 6; // each pixel is six sixteenths into its bin
    const double a = binLog2Luminance(10, 0), b = binLog2Luminance(20, 6),
                 c = binLog2Luminance(200, 0);
    EXPECT_NEAR(*percentileMeanLog2(histogram, 0, 1), (4 * a + 4 * b + 2 * c) / 10, 1e-13);
    EXPECT_NEAR(*percentileMeanLog2(histogram, 0.1, 0.7), (3 * a + 3 * b) / 6, 1e-13);
    EXPECT_NEAR(*percentileMeanLog2(histogram, 0.8, 0.9), c, 1e-13);
    EXPECT_EQ(percentileMeanLog2(Histogram{}, 0, 1), std::nullopt);
}

TEST(ReferenceExposure, followsTheSameCurveAtAnyFrameRate)
{
    const Histogram bright = average({1000}), dark = average({0.5f});
    std::vector<double> ends;
    for (const int rate : {15, 60, 240}) {
        double ev = 2;
        for (int i = 0; i < rate / 5; ++i)
            ev = adapt(bright, automatic(), ev, 1.0 / rate, false).adaptedEv100;
        for (int i = 0; i < rate * 2 / 5; ++i)
            ev = adapt(dark, automatic(), ev, 1.0 / rate, false).adaptedEv100;
        ends.push_back(ev);
    }
    EXPECT_NEAR(ends[1], ends[0], 1e-12);
    EXPECT_NEAR(ends[2], ends[0], 1e-12);
    // Closed form: 0.2 s upwards at speed 3, then 0.4 s downwards at speed 1.
    const double up = adapt(bright, automatic(), 0, 0, true).targetEv100;
    const double down = adapt(dark, automatic(), 0, 0, true).targetEv100;
    const double turn = up + (2 - up) * std::exp(-0.6);
    EXPECT_NEAR(ends[0], down + (turn - down) * std::exp(-0.4), 1e-12);
}

// An image with a spread of luminances that gets brighter in small steps.
TEST(ReferenceExposure, rampGivesMonotoneContinuousEv)
{
    std::vector<float> image(4096);
    double previous = -100, largest = 0;
    for (int step = 0; step <= 1000; ++step) {
        const double stops = -3 + 0.01 * step;
        for (size_t i = 0; i < image.size(); ++i) {
            const double spread = 4.0 * static_cast<double>(i) / static_cast<double>(image.size());
            image[i] = static_cast<float>(std::exp2(stops + spread));
        }
        const double ev = targetEv(image);
        if (step > 0) {
            ASSERT_GE(ev, previous) << "at " << stops;
            largest = std::max(largest, ev - previous);
        }
        previous = ev;
        // The mean of the spread is 2 stops and K adds 3. The assumed middle of a bin is off by at
        // most 0.01 on average.
        ASSERT_NEAR(ev, stops + 5, 0.02);
    }
    EXPECT_LT(largest, 0.03);
}

// Even for a uniform image the error is never more than half a sixteenth of a bin, and the EV never
// falls.
TEST(ReferenceExposure, flatPictureIsWithinAHundredthOfAStop)
{
    double previous = -100;
    for (double stops = -8; stops < 14; stops += 0.013) {
        const double ev = targetEv({static_cast<float>(std::exp2(stops))});
        ASSERT_GE(ev, previous);
        ASSERT_NEAR(ev, stops + 3, std::log2(1 + 0.5 / 8 / 16) + 1e-6);
        previous = ev;
    }
}

// A lit object in front of an empty background is exposed for the object.
TEST(ReferenceExposure, blackBackgroundIsLeftOut)
{
    const double object = targetEv({100, 200});
    EXPECT_EQ(targetEv({100, 200, 0, 0, 0, 0, -1, 0}), object);
    EXPECT_LT(targetEv({100, 200, 1e-20f, 1e-20f}), object);
    EXPECT_EQ(targetEv({0, 0}), automatic().minEv100);
}

TEST(ReferenceExposure, extremeInputsStayFinite)
{
    const CndExposureSettings settings = automatic();
    for (const float value : {0.0f, inf, -inf, nan}) {
        for (const bool reset : {false, true}) {
            const Adaptation result = adapt(average({value, value}), settings, 5, 0.1, reset);
            EXPECT_TRUE(std::isfinite(result.exposure)) << value;
            EXPECT_GE(result.adaptedEv100, settings.minEv100) << value;
            EXPECT_LE(result.adaptedEv100, settings.maxEv100) << value;
        }
    }
    // If nothing was metered the value stays, or starts from EV 0 after a reset.
    EXPECT_EQ(adapt(average({nan}), settings, 5, 0.1, false).adaptedEv100, 5);
    EXPECT_EQ(adapt(average({nan}), settings, 5, 0.1, true).adaptedEv100, 0);
}

TEST(ReferenceExposure, clampCompensationAndManualFollowTheContract)
{
    CndExposureSettings settings = automatic();
    settings.minEv100 = 4;
    EXPECT_EQ(adapt(average({0}), settings, 9, 0, true).adaptedEv100, 4);
    EXPECT_EQ(adapt(average({nan}), settings, 0, 0, true).adaptedEv100, 4);
    settings.compensation = 1;
    EXPECT_DOUBLE_EQ(adapt(average({0}), settings, 9, 0, true).exposure, double(0.18f));
    settings.manual = VK_TRUE;
    settings.manualEv100 = -3;
    const Adaptation manual = adapt(average({1}), settings, 9, 0.1, false);
    EXPECT_EQ(manual.targetEv100, -3);
    EXPECT_EQ(manual.adaptedEv100, -3);
    EXPECT_DOUBLE_EQ(manual.exposure, 128 * double(0.18f));                   // 2^(3 + 1) / 0.125
    EXPECT_EQ(adapt(average({1}), automatic(), 9, 0, false).adaptedEv100, 9); // no time has passed
}

} // namespace candelabra::test
