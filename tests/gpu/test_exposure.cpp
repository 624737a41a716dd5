// SPDX-License-Identifier: Apache-2.0
// Tests histogram, adaptation and the contract of the exposure module against the double-precision
// reference.
#include "gpu/exposure_harness.h"
#include "harness/constants.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "reference/eye_adaptation.h"

namespace candelabra::test
{
namespace
{

// Tolerance of EV100 against the double-precision reference: float32 sums of 256 products have a
// relative error of 256 * 6e-8, for values up to 20. This is a hundredth of what could be visible
// (0.01 EV).
constexpr double evTolerance = 1e-4;

void expectSameHistogram(const CndExposureStats& stats, const reference::Histogram& expected,
                         const std::string& what)
{
    EXPECT_EQ(stats.invalidPixels, expected.invalidPixels) << what;
    int wrong = 0;
    for (uint32_t bin = 0; bin < CND_HISTOGRAM_BINS; ++bin)
        if (stats.histogram[bin] != expected.counts[bin] && ++wrong == 1)
            ADD_FAILURE() << what << ": bin " << bin << " holds " << stats.histogram[bin]
                          << ", expected " << expected.counts[bin];
    EXPECT_EQ(wrong, 0) << what << ": wrong bins";
}

void expectSameAdaptation(const CndExposureStats& stats, const reference::Adaptation& expected,
                          const std::string& what)
{
    EXPECT_NEAR(stats.targetEv100, expected.targetEv100, evTolerance) << what;
    EXPECT_NEAR(stats.adaptedEv100, expected.adaptedEv100, evTolerance) << what;
    EXPECT_NEAR(stats.exposure / expected.exposure, 1, evTolerance) << what;
}

reference::Histogram histogramOf(const Picture& p, CndMetering metering = CND_METERING_AVERAGE,
                                 const reference::ExposureMask& mask = {})
{
    return reference::buildHistogram(p.rgba, p.width, p.height, metering, mask);
}

std::vector<std::string> kernelNames(const CndExposureStats& stats)
{
    std::vector<std::string> names;
    for (uint32_t i = 0; i < stats.kernelTimeCount; ++i)
        names.emplace_back(stats.kernelTimes[i].name);
    return names;
}

// 64 x 64 grey pixels over four stops from 2^stops upwards.
Picture spreadPicture(double stops)
{
    std::vector<float> values;
    for (int i = 0; i < 4096; ++i)
        values.push_back(float(std::exp2(stops + 4.0 * i / 4096)));
    return greyPicture(64, 64, values);
}

} // namespace

// The picture that is metered decides the exposure, and the other one is displayed.
TEST_F(ExposureTest, metersAnotherPictureThanItDisplays)
{
    const Picture shown = spreadPicture(2), metered = spreadPicture(5);
    const CndExposureStats alone = measure(metered, plainSettings());
    const gpu::Image shownImage = toDevice(shown), meteredImage = toDevice(metered),
                     displayed = createDisplay(64, 64), expected = createDisplay(64, 64);
    CndExposureFrame frame = frameOf(shownImage, plainSettings());
    frame.reset = VK_TRUE;
    frame.display = displayed.view.get();
    frame.meteredRadiance = meteredImage.view.get();
    const CndExposureStats both = run(frame);
    EXPECT_EQ(both.exposure, alone.exposure);
    EXPECT_TRUE(std::ranges::equal(both.histogram, alone.histogram));
    EXPECT_NE(both.exposure, measure(shown, plainSettings()).exposure);
    frame.meteredRadiance = VK_NULL_HANDLE;
    frame.display = expected.view.get();
    frame.settings.manual = VK_TRUE;
    frame.settings.manualEv100 = both.adaptedEv100;
    run(frame);
    const auto texels = [&](const gpu::Image& image) {
        return readImage(image, VK_IMAGE_ASPECT_COLOR_BIT, VK_IMAGE_LAYOUT_GENERAL, 4);
    };
    EXPECT_EQ(texels(displayed), texels(expected));
}

// For twenty random images and three metering modes every count, and everything computed from the
// counts, equals the reference.
TEST_F(ExposureTest, countsAreExact)
{
    std::mt19937 random(1);
    std::vector<uint8_t> weights;
    for (int i = 0; i < 7 * 5; ++i)
        weights.push_back(uint8_t(random() % 16));
    const reference::ExposureMask mask{weights, 7, 5};
    CndError error{};
    ASSERT_EQ(cndSetExposureMask(exposure_, weights.data(), 7, 5, &error), CND_SUCCESS);
    std::vector<std::pair<uint32_t, uint32_t>> sizes = {{1, 1},   {17, 3},   {1921, 1081}, {1, 300},
                                                        {300, 1}, {64, 64},  {65, 33},     {63, 31},
                                                        {2, 2},   {640, 360}};
    while (sizes.size() < 20)
        sizes.emplace_back(1 + random() % 200, 1 + random() % 200);
    uint64_t bins = 0;
    for (uint32_t i = 0; i < sizes.size(); ++i) {
        const Picture picture = wildPicture(sizes[i].first, sizes[i].second, 100 + i);
        const gpu::Image radiance = toDevice(picture);
        for (const CndMetering metering :
             {CND_METERING_AVERAGE, CND_METERING_CENTRE_WEIGHTED, CND_METERING_MASK}) {
            CndExposureSettings settings = plainSettings();
            settings.metering = metering;
            const CndExposureStats stats = run(frameOf(radiance, settings));
            const reference::Histogram expected = histogramOf(picture, metering, mask);
            const std::string what = std::to_string(picture.width) + "x" +
                                     std::to_string(picture.height) + " metering " +
                                     std::to_string(metering);
            expectSameHistogram(stats, expected, what);
            expectSameAdaptation(stats, reference::adapt(expected, settings, 0, 0, true), what);
            bins += CND_HISTOGRAM_BINS -
                    std::count(std::begin(stats.histogram), std::end(stats.histogram), 0u);
        }
    }
    EXPECT_GT(bins, 20u * 3 * 64); // the images do reach the bins
}

// Luminances at the edge of every bin, and the neighbouring floats.
TEST_F(ExposureTest, edgesAreExact)
{
    Picture picture{0, 1, {}};
    int onEdge = 0;
    for (int bin = -8; bin < CND_HISTOGRAM_BINS + 16; ++bin) {
        const float edge = std::ldexp(1 + float((bin + 8) % 8) / 8, (bin + 8) / 8 - 13);
        float green = edge / 0.7152f;
        for (int i = 0; i < 4; ++i)
            green = std::nextafter(green, 0.0f);
        for (int i = 0; i < 9; ++i, green = std::nextafter(green, infinity)) {
            picture.rgba.insert(picture.rgba.end(), {0, green, 0, 0});
            ++picture.width;
            onEdge += reference::histogramLuminance(0, green, 0) == edge;
        }
    }
    EXPECT_GT(onEdge, 200);
    expectSameHistogram(measure(picture, plainSettings()), histogramOf(picture), "edges");
}

// Counts beyond 2^24, and percentile windows of every width down to the narrowest.
TEST_F(ExposureTest, percentilesAreExactForLargeCounts)
{
    Picture picture{2048, 1536, {}};
    std::mt19937 random(7);
    for (size_t i = 0; i < size_t(picture.width) * picture.height; ++i) {
        const float value = float(std::exp2(-10 + 28 * std::pow(uniform(random), 3)));
        picture.rgba.insert(picture.rgba.end(), {value, value, value, 0});
    }
    const gpu::Image radiance = toDevice(picture);
    CndExposureSettings settings = plainSettings();
    settings.metering = CND_METERING_CENTRE_WEIGHTED;
    const reference::Histogram histogram = histogramOf(picture, settings.metering);
    const uint64_t total =
        std::accumulate(histogram.counts.begin(), histogram.counts.end(), uint64_t(0));
    ASSERT_GT(total, uint64_t(1) << 24);
    for (int i = 0; i < 40; ++i) {
        const double low = i ? uniform(random) : 0;
        const double width = std::pow(10.0, -6 * uniform(random));
        settings.lowPercentile = float(low);
        settings.highPercentile = i ? float(std::min(1.0, low + 2e-6 + width)) : 1.0f;
        const CndExposureStats stats = run(frameOf(radiance, settings));
        expectSameAdaptation(stats, reference::adapt(histogram, settings, 0, 0, true),
                             std::to_string(settings.lowPercentile) + ".." +
                                 std::to_string(settings.highPercentile));
    }
}

TEST_F(ExposureTest, rampGivesMonotoneContinuousEv)
{
    double previous = 0, largest = 0;
    constexpr double step = 0.02;
    for (int i = 0; i <= 500; ++i) {
        const double stops = -3 + step * i;
        const double ev = measure(spreadPicture(stops), plainSettings()).targetEv100;
        if (i > 0) {
            ASSERT_GE(ev, previous) << "at " << stops;
            largest = std::max(largest, ev - previous);
        }
        previous = ev;
        // The mean of the spread is 2 stops, and K adds 3.
        ASSERT_NEAR(ev, stops + 5, 0.02);
    }
    EXPECT_LT(largest, 2 * step);
}

// 0.4 s of adaptation to a bright image, then 1.2 s to a dark one.
TEST_F(ExposureTest, sameCurveAtAnyFrameRate)
{
    const gpu::Image bright = toDevice(flatPicture(8, 8, 3000));
    const gpu::Image dark = toDevice(flatPicture(8, 8, 0.2f));
    std::vector<std::vector<double>> curves; // sampled at 15 Hz
    for (const int rate : {15, 60, 240}) {
        std::vector<double> curve;
        CndExposureFrame frame = frameOf(bright, plainSettings());
        run(frameOf(dark, plainSettings()));
        frame.reset = VK_FALSE;
        frame.deltaTime = 1.0f / float(rate);
        for (int i = 1; i <= rate * 24 / 15; ++i) {
            frame.radiance = i <= rate * 6 / 15 ? bright.view.get() : dark.view.get();
            const double ev = run(frame).adaptedEv100;
            if (i % (rate / 15) == 0)
                curve.push_back(ev);
        }
        curves.push_back(curve);
    }
    ASSERT_EQ(curves[0].size(), 24u);
    const CndExposureSettings settings = plainSettings();
    const auto target = [&](float value) {
        return reference::adapt(histogramOf(flatPicture(1, 1, value)), settings, 0, 0, true)
            .targetEv100;
    };
    const double turn = target(3000) + (target(0.2f) - target(3000)) * std::exp(-0.4 * 3);
    for (size_t i = 0; i < 24; ++i) {
        const double t = double(i + 1) / 15;
        const double expected =
            t <= 0.4 + 1e-9 ? target(3000) + (target(0.2f) - target(3000)) * std::exp(-t * 3)
                            : target(0.2f) + (turn - target(0.2f)) * std::exp(0.4 - t);
        for (const std::vector<double>& curve : curves)
            EXPECT_NEAR(curve[i], expected, 1e-3) << "at " << t << " s";
    }
}

TEST_F(ExposureTest, extremeInputsStayFinite)
{
    const CndExposureSettings settings = plainSettings();
    for (const float value : {0.0f, infinity, -infinity, nan, -1.0f, 1e-40f})
        for (const bool reset : {true, false}) {
            const Picture picture = flatPicture(33, 9, value);
            const gpu::Image radiance = toDevice(picture);
            const double before =
                run(frameOf(toDevice(flatPicture(1, 1, 9)), settings)).adaptedEv100;
            CndExposureFrame frame = frameOf(radiance, settings);
            frame.reset = reset;
            frame.deltaTime = 0.1f;
            const CndExposureStats stats = run(frame);
            EXPECT_TRUE(std::isfinite(stats.exposure)) << value;
            expectSameAdaptation(
                stats, reference::adapt(histogramOf(picture), settings, before, 0.1f, reset),
                std::to_string(value));
        }
}

TEST_F(ExposureTest, compensationAndRange)
{
    const Picture picture = spreadPicture(4);
    CndExposureSettings settings = plainSettings();
    const CndExposureStats plain = measure(picture, settings);
    settings.compensation = 1;
    const CndExposureStats brighter = measure(picture, settings);
    EXPECT_EQ(brighter.adaptedEv100, plain.adaptedEv100);
    EXPECT_NEAR(brighter.exposure / plain.exposure, 2, 1e-5);
    settings = plainSettings();
    settings.minEv100 = 12;
    EXPECT_EQ(measure(picture, settings).adaptedEv100, 12);
    settings.minEv100 = settings.maxEv100 = -2.5f;
    EXPECT_EQ(measure(picture, settings).targetEv100, -2.5f);
    // If the range moves away from the history, the history follows at once.
    settings = plainSettings();
    settings.minEv100 = 3;
    const gpu::Image black = toDevice(flatPicture(2, 2, 0));
    CndExposureFrame frame = frameOf(black, settings);
    frame.reset = VK_FALSE;
    EXPECT_EQ(run(frame).adaptedEv100, 3);
}

TEST_F(ExposureTest, historySurvivesAChangeOfSize)
{
    const gpu::Image small = toDevice(flatPicture(5, 7, 100));
    const gpu::Image large = toDevice(flatPicture(300, 200, 0.01f));
    const float before = run(frameOf(small, plainSettings())).adaptedEv100;
    CndExposureFrame frame = frameOf(large, plainSettings());
    frame.reset = VK_FALSE;
    EXPECT_EQ(run(frame).adaptedEv100, before); // no time has passed
    frame.deltaTime = 0.5f;
    const CndExposureStats after = run(frame);
    EXPECT_NEAR(after.adaptedEv100,
                after.targetEv100 + (before - after.targetEv100) * std::exp(-0.5), evTolerance);
}

TEST_F(ExposureTest, manualBuildsNoHistogram)
{
    const Picture picture = flatPicture(40, 30, 5);
    const gpu::Image radiance = toDevice(picture);
    const gpu::Image target = createDisplay(40, 30);
    CndExposureFrame frame = frameOf(radiance, plainSettings());
    frame.display = target.view.get();
    EXPECT_EQ(kernelNames(run(frame)),
              (std::vector<std::string>{"luminance_histogram", "adapt_exposure", "tone_map"}));
    frame.settings = manualSettings(7.5f, CND_TONEMAP_NONE);
    frame.settings.compensation = -1;
    const CndExposureStats stats = run(frame);
    EXPECT_EQ(kernelNames(stats), (std::vector<std::string>{"adapt_exposure", "tone_map"}));
    expectSameHistogram(stats, {}, "manual");
    expectSameAdaptation(stats, reference::adapt({}, frame.settings, 0, 0, false), "manual");
    EXPECT_EQ(stats.adaptedEv100, 7.5f);
    ASSERT_EQ(stats.passCount, 3u);
    EXPECT_STREQ(stats.passes[0].skipped, "manual exposure");
    EXPECT_EQ(stats.passes[2].skipped, nullptr);
    frame.display = VK_NULL_HANDLE;
    const CndExposureStats adapted = run(frame);
    EXPECT_EQ(kernelNames(adapted), std::vector<std::string>{"adapt_exposure"});
    EXPECT_STREQ(adapted.passes[2].skipped, "no display image");
}

// Frames that are recorded into one command buffer adapt like the same frames submitted one by one.
TEST_F(ExposureTest, framesInFlightFollowOneAnother)
{
    const gpu::Image images[] = {toDevice(wildPicture(97, 61, 5)), toDevice(spreadPicture(9)),
                                 toDevice(flatPicture(3, 3, 0.5f))};
    const auto frame = [&](uint32_t i) {
        CndExposureFrame f = frameOf(images[i], plainSettings());
        f.frameSlot = i;
        f.reset = i == 0;
        f.deltaTime = 0.3f;
        return f;
    };
    CndExposureStats serial[slotCount];
    for (uint32_t i = 0; i < slotCount; ++i)
        serial[i] = run(frame(i));
    context().submitAndWait([&](VkCommandBuffer cmd) {
        for (uint32_t i = 0; i < slotCount; ++i)
            record(cmd, frame(i));
    });
    for (uint32_t i = 0; i < slotCount; ++i) {
        const CndExposureStats together = stats(i);
        EXPECT_EQ(together.adaptedEv100, serial[i].adaptedEv100) << i;
        EXPECT_EQ(together.exposure, serial[i].exposure) << i;
        EXPECT_TRUE(std::ranges::equal(together.histogram, serial[i].histogram)) << i;
    }
}

// The first frame that is executed is a reset, even if an earlier one was recorded and discarded.
TEST_F(ExposureTest, unsubmittedFramesLeaveNoTrace)
{
    CndExposureStats stats{.structSize = sizeof stats};
    EXPECT_EQ(cndGetExposureStats(exposure_, 0, &stats), CND_ERROR_INVALID_ARGUMENT);
    const gpu::Image radiance = toDevice(flatPicture(4, 4, 50));
    CndExposureFrame frame = frameOf(radiance, plainSettings());
    frame.reset = VK_FALSE;
    const VkDevice device = deviceDesc().device;
    const VkCommandPoolCreateInfo poolInfo{.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                           .queueFamilyIndex = context().queueFamily()};
    VkCommandPool pool{};
    ASSERT_EQ(vkCreateCommandPool(device, &poolInfo, nullptr, &pool), VK_SUCCESS);
    const VkCommandBufferAllocateInfo info{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                           .commandPool = pool,
                                           .commandBufferCount = 1};
    VkCommandBuffer cmd{};
    ASSERT_EQ(vkAllocateCommandBuffers(device, &info, &cmd), VK_SUCCESS);
    const VkCommandBufferBeginInfo begin{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    ASSERT_EQ(vkBeginCommandBuffer(cmd, &begin), VK_SUCCESS);
    record(cmd, frame);
    ASSERT_EQ(vkEndCommandBuffer(cmd), VK_SUCCESS);
    EXPECT_EQ(cndGetExposureStats(exposure_, 0, &stats), CND_NOT_READY);
    vkDestroyCommandPool(device, pool, nullptr);
    const CndExposureStats first = run(frame);
    EXPECT_EQ(first.adaptedEv100, first.targetEv100);
    EXPECT_NEAR(first.targetEv100, std::log2(50) + 3, 0.1);
}

} // namespace candelabra::test
