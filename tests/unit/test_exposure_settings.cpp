// SPDX-License-Identifier: Apache-2.0
// Tests defaults, ranges and conversions of the exposure module: everything that needs no device.
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "exposure/exposure_module.h"
#include "harness/constants.h"

namespace candelabra::test
{
namespace
{

CndExposureSettings defaults()
{
    CndExposureSettings settings{};
    cndDefaultExposureSettings(&settings);
    return settings;
}

// Returns the message of the failure; empty if there is none.
std::string refusal(const std::function<void()>& action)
{
    try {
        action();
    } catch (const gpu::Failure& failure) {
        EXPECT_EQ(failure.code, CND_ERROR_INVALID_ARGUMENT);
        return failure.message;
    }
    return "";
}

} // namespace

TEST(ExposureSettings, defaultsAreAsDocumentedAndValid)
{
    const CndExposureSettings s = defaults();
    EXPECT_FALSE(s.manual);
    EXPECT_EQ(s.compensation, 0);
    EXPECT_EQ(s.middleGrey, 0.18f);
    EXPECT_EQ(s.minEv100, -6);
    EXPECT_EQ(s.maxEv100, 18);
    EXPECT_EQ(s.lowPercentile, 0.10f);
    EXPECT_EQ(s.highPercentile, 0.90f);
    EXPECT_EQ(s.speedUp, 3);
    EXPECT_EQ(s.speedDown, 1);
    EXPECT_EQ(s.metering, CND_METERING_CENTRE_WEIGHTED);
    EXPECT_EQ(s.toneMap, CND_TONEMAP_PBR_NEUTRAL);
    EXPECT_TRUE(s.dither);
    EXPECT_EQ(refusal([&] { exposure::validateSettings(s); }), "");
}

TEST(ExposureSettings, everyFieldOutOfRangeIsNamed)
{
    struct Case {
        const char* field;
        std::vector<float> bad, good;
        float CndExposureSettings::*member;
    };
    const Case cases[] = {
        {"manualEv100", {-65, 65, nan, infinity}, {-64, 64}, &CndExposureSettings::manualEv100},
        {"compensation", {-33, 33, nan, infinity}, {-32, 32}, &CndExposureSettings::compensation},
        {"middleGrey",
         {0, -0.18f, 1.001f, nan, infinity},
         {1e-6f, 1},
         &CndExposureSettings::middleGrey},
        {"minEv100", {-65, 18.5f, nan, -infinity}, {-64, 18}, &CndExposureSettings::minEv100},
        {"maxEv100", {65, -6.5f, nan, infinity}, {64, -6}, &CndExposureSettings::maxEv100},
        {"percentiles", {-0.01f, 0.9f, 1, nan}, {0, 0.89f}, &CndExposureSettings::lowPercentile},
        {"percentiles", {1.01f, 0.1f, 0, nan}, {1, 0.11f}, &CndExposureSettings::highPercentile},
        {"speedUp", {0, -1, nan, infinity}, {1e-6f, 1e6f}, &CndExposureSettings::speedUp},
        {"speedDown", {0, -1, nan, infinity}, {1e-6f, 1e6f}, &CndExposureSettings::speedDown}};
    for (const Case& c : cases) {
        CndExposureSettings s = defaults();
        for (const float value : c.bad) {
            s.*c.member = value;
            const std::string sentence = refusal([&] { exposure::validateSettings(s); });
            EXPECT_NE(sentence.find(c.field), std::string::npos)
                << c.field << ' ' << value << ": " << sentence;
        }
        for (const float value : c.good) {
            s.*c.member = value;
            EXPECT_EQ(refusal([&] { exposure::validateSettings(s); }), "") << c.field << value;
        }
    }
    CndExposureSettings s = defaults();
    s.metering = CndMetering(3);
    EXPECT_NE(refusal([&] { exposure::validateSettings(s); }).find("metering"), std::string::npos);
    s = defaults();
    s.toneMap = CND_TONEMAP_COUNT;
    EXPECT_NE(refusal([&] { exposure::validateSettings(s); }).find("toneMap"), std::string::npos);
}

TEST(ExposureSettings, masksOutOfRangeAreRefused)
{
    std::vector<uint8_t> weights(64 * 64, 15);
    EXPECT_EQ(refusal([&] { exposure::validateMask(weights.data(), 64, 64); }), "");
    for (const auto& size : {std::pair{0u, 1u}, {1u, 0u}, {65u, 1u}, {1u, 65u}})
        EXPECT_NE(refusal([&] { exposure::validateMask(weights.data(), size.first, size.second); }),
                  "");
    weights[70] = 16;
    EXPECT_NE(refusal([&] { exposure::validateMask(weights.data(), 64, 64); }).find("[70] is 16"),
              std::string::npos);
}

TEST(ExposureSettings, parametersAreExact)
{
    CndExposureSettings s = defaults();
    s.lowPercentile = 0.25f;
    s.highPercentile = 1;
    gpu::AdaptExposureParams p = exposure::adaptParams(s, 0.5f, true);
    EXPECT_EQ(p.lowShare, 1u << 30);
    EXPECT_EQ(p.highShare, 0u);
    EXPECT_EQ(p.reset, 1u);
    EXPECT_EQ(p.middleGrey, 0.18f);
    EXPECT_FLOAT_EQ(p.keepUp, std::exp(-1.5f));
    EXPECT_FLOAT_EQ(p.keepDown, std::exp(-0.5f));
    s.lowPercentile = 0;
    s.highPercentile = 1e-6f;
    p = exposure::adaptParams(s, 0, false);
    EXPECT_EQ(p.lowShare, 0u);
    EXPECT_NEAR(double(p.highShare) / 4294967296.0, 1 - 1e-6, 1e-9);
    EXPECT_EQ(p.reset, 0u);
    EXPECT_EQ(p.keepUp, 1);
    // A frame that lasts an hour completes the adaptation.
    EXPECT_EQ(exposure::adaptParams(s, 3600, false).keepUp, 0);
}

TEST(ExposureConversions, knownCameras)
{
    // "Sunny 16": f/16, 1/100 s at ISO 100 is EV 14.6.
    EXPECT_NEAR(cndEv100FromCamera(16, 0.01f, 100), 14.644, 1e-3);
    EXPECT_NEAR(cndEv100FromCamera(1, 1, 100), 0, 1e-6);
    EXPECT_NEAR(cndEv100FromCamera(1, 1, 400), -2, 1e-6);
    // EV100 3 is a luminance of 1 cd/m^2 (K = 12.5).
    EXPECT_FLOAT_EQ(cndExposureFromEv100(3, 0.18f), 0.18f);
    EXPECT_FLOAT_EQ(cndExposureFromEv100(5, 0.25f), 0.0625f);
    // The calibration of ISO 12232 by saturation: 9.6 cd/m^2 saturate at EV100 3.
    EXPECT_NEAR(cndExposureFromEv100(3, 12.5f / 120) * 9.6, 1, 1e-6);
}

} // namespace candelabra::test
