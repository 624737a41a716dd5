// SPDX-License-Identifier: Apache-2.0
// Tests what the exposure module writes to the display, and the arguments that it refuses.
#include "gpu/exposure_harness.h"
#include "harness/constants.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <string>

#include "reference/eye_adaptation.h"
#include "reference/tone_map.h"

namespace candelabra::test
{
namespace
{

// Colours from far below black to far beyond white, including saturated ones.
Picture colours(uint32_t width, uint32_t height)
{
    std::mt19937 random(3);
    Picture p{width, height, {}};
    for (size_t i = 0; i < size_t(width) * height; ++i) {
        const double level = std::exp2(-14 + 24 * uniform(random));
        for (int c = 0; c < 3; ++c)
            p.rgba.push_back(random() % 16 ? float(level * uniform(random)) : 0.0f);
        p.rgba.push_back(nan);
    }
    return p;
}

// Manual exposure that maps `luminance` to 1.
CndExposureSettings whiteAt(double luminance)
{
    CndExposureSettings settings =
        manualSettings(float(std::log2(8 * luminance)), CND_TONEMAP_NONE);
    settings.middleGrey = 1;
    return settings;
}

double decodeSrgb(double encoded)
{
    return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

struct Moments {
    double mean, variance;
};

// Returns mean and variance over all channels of an image, in steps of 1/255.
Moments ditheredMoments(const std::vector<uint8_t>& rgba)
{
    double sum = 0, squares = 0, count = 0;
    for (size_t i = 0; i < rgba.size(); ++i)
        if (i % 4 != 3) {
            sum += rgba[i];
            squares += double(rgba[i]) * rgba[i];
            ++count;
        }
    return {sum / count, squares / count - sum / count * sum / count};
}

} // namespace

TEST_F(ExposureTest, everyCurveMatchesTheReference)
{
    const Picture picture = colours(123, 77);
    for (uint32_t i = 0; i < CND_TONEMAP_COUNT; ++i) {
        const CndExposureSettings settings = manualSettings(0.7f, CndToneMap(i));
        const double exposure = reference::exposureFromEv100(0.7f, 0, settings.middleGrey);
        const std::vector<uint8_t> rgba = display(picture, settings);
        ASSERT_EQ(rgba.size(), picture.rgba.size());
        double worst = 0;
        size_t where = 0, levels = 0;
        std::vector<bool> seen(256);
        for (size_t p = 0; p < rgba.size(); p += 4) {
            const glm::dvec3 radiance(picture.rgba[p], picture.rgba[p + 1], picture.rgba[p + 2]);
            const glm::dvec3 linear = reference::toneMap(settings.toneMap, exposure * radiance);
            for (size_t c = 0; c < 3; ++c) {
                const double error =
                    std::abs(rgba[p + c] - 255 * reference::srgbEncode(linear[int(c)]));
                levels += !seen[rgba[p + c]];
                seen[rgba[p + c]] = true;
                if (!(error <= worst)) {
                    worst = error;
                    where = p / 4;
                }
            }
            ASSERT_EQ(rgba[p + 3], 255);
        }
        // Rounding to whole steps costs up to half a step; the rest is float32.
        EXPECT_LE(worst, 0.52) << "curve " << i << ", pixel " << where;
        EXPECT_GT(levels, 200u) << "curve " << i; // the image covers the whole range
    }
}

TEST_F(ExposureTest, displayIsDefinedForAnyRadiance)
{
    const float values[] = {nan, -nan, -1, -infinity, -0.0f, 1e-42f, infinity, 3e38f};
    constexpr size_t dark = 6; // the first six values are displayed as black
    for (uint32_t i = 0; i < CND_TONEMAP_COUNT; ++i)
        for (const float ev : {-64.0f, 0.0f, 64.0f}) {
            CndExposureSettings settings = manualSettings(ev, CndToneMap(i));
            const std::vector<uint8_t> rgba =
                display(greyPicture(8, 1, {std::begin(values), std::end(values)}), settings);
            for (size_t p = 0; p < std::size(values); ++p)
                for (size_t c = 0; c < 3; ++c) {
                    const std::string what = "curve " + std::to_string(i) + " EV " +
                                             std::to_string(ev) + " value " +
                                             std::to_string(values[p]);
                    if (p < dark && !(ev < 0 && values[p] > 0)) {
                        EXPECT_EQ(rgba[4 * p + c], 0) << what;
                    } else if (p >= dark) {
                        EXPECT_GE(rgba[4 * p + c], 250) << what;
                    }
                }
        }
    // A NaN in one channel does not affect the other channels.
    const std::vector<uint8_t> mixed =
        display({1, 1, {nan, 1.2f, infinity, 0}}, manualSettings(0, CND_TONEMAP_NONE));
    EXPECT_EQ(mixed, (std::vector<uint8_t>{0, 255, 255, 255}));
}

// The mean is kept at every value. Away from the ends the variance is 1/4: triangular noise 1/6
// plus rounding 1/12.
TEST_F(ExposureTest, ditherKeepsTheMean)
{
    constexpr uint32_t side = 256;
    for (const double steps :
         {0.0, 0.1, 0.3, 0.5, 0.8, 1.2, 10.5, 100.3, 127.0, 254.2, 254.7, 255.0}) {
        CndExposureSettings settings = whiteAt(1);
        settings.dither = VK_TRUE;
        const float value = float(decodeSrgb(steps / 255));
        const std::vector<uint8_t> rgba = display(flatPicture(side, side, value), settings, 11);
        const Moments m = ditheredMoments(rgba);
        // The standard error is 0.5 / sqrt(3 * 65536) = 0.0011; value and exposure are float32.
        EXPECT_NEAR(m.mean, steps, 0.006) << steps;
        if (steps > 1 && steps < 254) {
            EXPECT_NEAR(m.variance, 0.25, 0.01) << steps;
        }
        if (steps == 0 || steps == 255) {
            EXPECT_EQ(m.variance, 0) << steps;
        }
    }
}

TEST_F(ExposureTest, sameSeedSameDisplay)
{
    const Picture picture = colours(200, 100);
    CndExposureSettings settings = plainSettings();
    settings.dither = VK_TRUE;
    const std::vector<uint8_t> first = display(picture, settings, 5);
    EXPECT_EQ(display(picture, settings, 5), first);
    EXPECT_NE(display(picture, settings, 6), first);
    settings.dither = VK_FALSE;
    EXPECT_EQ(display(picture, settings, 5), display(picture, settings, 6));
}

// Automatic exposure reaches the display: a uniform grey is displayed as the reference predicts.
TEST_F(ExposureTest, automaticExposureReachesTheDisplay)
{
    const Picture picture = flatPicture(31, 17, 700);
    CndExposureSettings settings = plainSettings();
    settings.toneMap = CND_TONEMAP_NONE;
    const reference::Histogram histogram = reference::buildHistogram(
        picture.rgba, picture.width, picture.height, CND_METERING_AVERAGE);
    const double exposure = reference::adapt(histogram, settings, 0, 0, true).exposure;
    const std::vector<uint8_t> rgba = display(picture, settings);
    for (size_t i = 0; i < rgba.size(); ++i) {
        const double expected = i % 4 == 3 ? 1 : reference::srgbEncode(700 * exposure);
        ASSERT_NEAR(rgba[i], 255 * expected, 0.51);
    }
}

// A grey card in sunlight: a diffuse albedo of 0.18 under 100,000 lx has a luminance of 5730
// cd/m^2. Whatever is metered, and with every curve, it is exposed at 0.18 and displayed at 0.18 of
// white.
TEST_F(ExposureTest, aGreyCardIsDisplayedAsMiddleGrey)
{
    constexpr double middleGrey = 0.18, withinEv = 0.02;
    const std::vector<uint8_t> weights{0, 3, 15, 1};
    CndError error{};
    ASSERT_EQ(cndSetExposureMask(exposure_, weights.data(), 2, 2, &error), CND_SUCCESS);
    for (const double illuminance : {0.2, 10.0, 1'000.0, 100'000.0}) {
        const float luminance = float(middleGrey * illuminance / 3.14159265358979);
        const Picture card = flatPicture(33, 17, luminance);
        const auto expectMiddleGrey = [&](CndExposureSettings settings, const std::string& what) {
            const double exposed = double(luminance) * double(measure(card, settings).exposure);
            EXPECT_NEAR(std::log2(exposed / middleGrey), 0, withinEv) << what;
            for (uint32_t curve = 0; curve < CND_TONEMAP_COUNT; ++curve) {
                settings.toneMap = CndToneMap(curve);
                const std::vector<uint8_t> rgba = display(card, settings);
                // Half a step of 255 is 0.015 EV here.
                for (size_t c = 0; c < 3; ++c)
                    EXPECT_NEAR(std::log2(decodeSrgb(rgba[c] / 255.0) / middleGrey), 0,
                                withinEv + 0.015)
                        << what << ", curve " << curve;
            }
        };
        const std::string lux = std::to_string(illuminance) + " lx, ";
        for (const CndMetering metering :
             {CND_METERING_AVERAGE, CND_METERING_CENTRE_WEIGHTED, CND_METERING_MASK}) {
            CndExposureSettings settings = plainSettings();
            settings.metering = metering;
            expectMiddleGrey(settings, lux + "metering " + std::to_string(metering));
        }
        // By hand: a reflected-light meter with K = 12.5 reads log2(L 100 / 12.5).
        expectMiddleGrey(manualSettings(std::log2(luminance * 8), CND_TONEMAP_NONE),
                         lux + "manual");
    }
}

// The calibration is linear: another middle grey scales exposed values, in both modes.
TEST_F(ExposureTest, middleGreyScalesTheExposure)
{
    const Picture picture = flatPicture(9, 9, 40);
    for (CndExposureSettings settings : {plainSettings(), manualSettings(8, CND_TONEMAP_NONE)}) {
        const double usual = double(measure(picture, settings).exposure);
        settings.middleGrey = 0.045f;
        EXPECT_NEAR(double(measure(picture, settings).exposure) / usual, 0.25, 1e-5);
    }
}

// A rectangle of larger images is metered, weighted and dithered as images of its own are.
TEST_F(ExposureTest, aRectangleHasTheBitsOfAWholeImage)
{
    constexpr uint32_t width = 64, height = 48, x0 = 19, y0 = 13;
    const Picture own = colours(width, height);
    Picture atlas = flatPicture(101, 75, 1e6f);
    for (uint32_t y = 0; y < height; ++y)
        std::copy_n(own.rgba.begin() + y * width * 4, width * 4,
                    atlas.rgba.begin() + ((y0 + y) * atlas.width + x0) * 4);
    CndExposureSettings settings = plainSettings();
    settings.metering = CND_METERING_CENTRE_WEIGHTED;
    settings.dither = VK_TRUE;
    const std::vector<uint8_t> expected = display(own, settings, 5);
    const CndExposureStats alone = stats(0);

    const gpu::Image radiance = toDevice(atlas), target = createDisplay(atlas.width, atlas.height);
    CndExposureFrame frame = frameOf(radiance, settings);
    frame.x = x0;
    frame.y = y0;
    frame.width = width;
    frame.height = height;
    frame.display = target.view.get();
    frame.ditherSeed = 5;
    const CndExposureStats part = run(frame);
    EXPECT_EQ(part.exposure, alone.exposure);
    EXPECT_TRUE(std::ranges::equal(part.histogram, alone.histogram));
    const std::vector<std::byte> shown =
        readImage(target, VK_IMAGE_ASPECT_COLOR_BIT, VK_IMAGE_LAYOUT_GENERAL, 4);
    for (uint32_t y = 0; y < height; ++y)
        EXPECT_EQ(std::memcmp(&shown[((y0 + y) * atlas.width + x0) * 4], &expected[y * width * 4],
                              width * 4),
                  0)
            << "row " << y;
}

// A frame with deltaTime 0 displays another image by the exposure of the frame before. Two views
// with images of their own share an exposure in this way.
TEST_F(ExposureTest, noTimeKeepsTheExposure)
{
    const gpu::Image bright = toDevice(flatPicture(8, 8, 500)),
                     dark = toDevice(flatPicture(4, 4, 0.1f));
    const float first = run(frameOf(bright, plainSettings())).exposure;
    CndExposureFrame second = frameOf(dark, plainSettings());
    second.reset = VK_FALSE;
    second.deltaTime = 0;
    EXPECT_NEAR(run(second).exposure / first, 1, 1e-5);
    second.deltaTime = 1;
    EXPECT_GT(run(second).exposure / first, 1.5f);
}

TEST_F(ExposureTest, badArgumentsAreRefusedWithASentence)
{
    const gpu::Image radiance = toDevice(flatPicture(4, 4, 1));
    struct Case {
        const char* word; // must occur in the error message
        std::function<void(CndExposureFrame&)> spoil;
    };
    const Case cases[] = {
        {"structSize", [](CndExposureFrame& f) { f.structSize = 8; }},
        {"frameSlot", [](CndExposureFrame& f) { f.frameSlot = slotCount; }},
        {"size 0x4", [](CndExposureFrame& f) { f.width = 0; }},
        {"size 4x16385", [](CndExposureFrame& f) { f.height = 16385; }},
        {"4x4 pixels at (0, 16381) ends", [](CndExposureFrame& f) { f.y = 16381; }},
        {"radiance", [](CndExposureFrame& f) { f.radiance = VK_NULL_HANDLE; }},
        {"deltaTime", [](CndExposureFrame& f) { f.deltaTime = -1; }},
        {"deltaTime", [](CndExposureFrame& f) { f.deltaTime = nan; }},
        {"deltaTime", [](CndExposureFrame& f) { f.deltaTime = infinity; }},
        {"compensation", [](CndExposureFrame& f) { f.settings.compensation = nan; }},
        {"mask", [](CndExposureFrame& f) { f.settings.metering = CND_METERING_MASK; }}};
    for (const Case& c : cases) {
        CndExposureFrame frame = frameOf(radiance, plainSettings());
        c.spoil(frame);
        CndError error{};
        context().submitAndWait([&](VkCommandBuffer cmd) {
            EXPECT_EQ(cndRecordExposure(exposure_, cmd, &frame, &error), CND_ERROR_INVALID_ARGUMENT)
                << c.word;
        });
        EXPECT_NE(std::string(error.message).find(c.word), std::string::npos) << error.message;
    }
    const CndExposureFrame good = frameOf(radiance, plainSettings());
    CndError error{};
    EXPECT_EQ(cndRecordExposure(exposure_, VK_NULL_HANDLE, &good, &error),
              CND_ERROR_INVALID_ARGUMENT);
    const uint8_t weight = 16;
    EXPECT_EQ(cndSetExposureMask(exposure_, &weight, 1, 1, &error), CND_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(cndSetExposureMask(exposure_, nullptr, 1, 1, &error), CND_ERROR_INVALID_ARGUMENT);
    CndExposureStats stats{.structSize = sizeof stats};
    EXPECT_EQ(cndGetExposureStats(exposure_, slotCount, &stats), CND_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(cndGetExposureStats(nullptr, 0, &stats), CND_ERROR_INVALID_ARGUMENT);
    CndExposure none{};
    for (const uint32_t frames : {0u, 9u}) {
        const CndExposureDesc desc{.structSize = sizeof desc, .framesInFlight = frames};
        EXPECT_EQ(cndCreateExposure(&deviceDesc(), &desc, &none, &error),
                  CND_ERROR_INVALID_ARGUMENT);
        EXPECT_NE(std::string(error.message).find("framesInFlight"), std::string::npos);
    }
}

} // namespace candelabra::test
