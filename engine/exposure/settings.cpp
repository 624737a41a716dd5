// SPDX-License-Identifier: Apache-2.0
// Defaults and ranges of the exposure settings, and the exposure arithmetic of a camera.
#include <algorithm>
#include <cmath>
#include <string>

#include "exposure/exposure_module.h"

namespace candelabra::exposure
{
namespace
{

// Starlight is about EV -16 and the sun's disc EV 33. With any allowed compensation and middle grey
// the exposure factor, 8 * middleGrey / 2^EV, is still a normal float.
constexpr float maxEv100 = 64;
constexpr float maxCompensation = 32;
constexpr float minMiddleGrey = 1e-6f;
// Percentiles are passed to the kernel in units of 2^-32, of which the smallest window is 4295.
constexpr double minPercentileWindow = 1e-6;

void require(bool condition, const char* sentence)
{
    if (!condition)
        gpu::failArgument(sentence);
}

// Fails for NaN too: the comparison is written so.
void requireWithin(const char* field, float value, float limit)
{
    if (!(std::abs(value) <= limit))
        gpu::failArgument(std::string("CndExposureSettings: ") + field + " must be within -" +
                          std::to_string(int(limit)) + ".." + std::to_string(int(limit)) + ", is " +
                          std::to_string(value));
}

void requirePositive(const char* field, float value)
{
    if (!(value > 0 && std::isfinite(value)))
        gpu::failArgument(std::string("CndExposureSettings: ") + field +
                          " must be finite and > 0, is " + std::to_string(value));
}

// Returns `share`, in [0, 1), in units of 2^-32.
uint32_t fixedPoint(double share)
{
    constexpr double one = 4294967296.0;
    return uint32_t(std::min(std::round(share * one), one - 1));
}

} // namespace

void validateSettings(const CndExposureSettings& s)
{
    requireWithin("manualEv100", s.manualEv100, maxEv100);
    requireWithin("compensation", s.compensation, maxCompensation);
    if (!(s.middleGrey >= minMiddleGrey && s.middleGrey <= 1))
        gpu::failArgument("CndExposureSettings: middleGrey must be from 0.000001 to 1, is " +
                          std::to_string(s.middleGrey));
    requireWithin("minEv100", s.minEv100, maxEv100);
    requireWithin("maxEv100", s.maxEv100, maxEv100);
    require(s.minEv100 <= s.maxEv100, "CndExposureSettings: minEv100 must not exceed maxEv100");
    const double low = s.lowPercentile, high = s.highPercentile;
    require(low >= 0 && high <= 1 && high - low >= minPercentileWindow,
            "CndExposureSettings: percentiles must satisfy 0 <= low, low + 0.000001 <= high, "
            "high <= 1");
    requirePositive("speedUp", s.speedUp);
    requirePositive("speedDown", s.speedDown);
    require(uint32_t(s.metering) <= CND_METERING_MASK,
            "CndExposureSettings: metering is not a CndMetering");
    require(uint32_t(s.toneMap) < CND_TONEMAP_COUNT,
            "CndExposureSettings: toneMap is not a CndToneMap");
}

void validateMask(const uint8_t* weights, uint32_t width, uint32_t height)
{
    constexpr uint32_t maxSide = 64;
    require(weights, "cndSetExposureMask: weights is null");
    require(width >= 1 && width <= maxSide && height >= 1 && height <= maxSide,
            "cndSetExposureMask: the mask must be 1x1..64x64");
    for (uint32_t i = 0; i < width * height; ++i)
        if (weights[i] > gpu::MAX_METERING_WEIGHT)
            gpu::failArgument("cndSetExposureMask: weights[" + std::to_string(i) + "] is " +
                              std::to_string(weights[i]) + ", the largest weight is 15");
}

gpu::AdaptExposureParams adaptParams(const CndExposureSettings& s, float deltaTime,
                                     bool reset) noexcept
{
    // In double precision: the factors exp(-dt speed) of many short steps must multiply to that of
    // one long step.
    const auto keep = [&](float speed) { return float(std::exp(-double(deltaTime) * speed)); };
    return {.manual = s.manual ? 1u : 0u,
            .reset = reset ? 1u : 0u,
            .manualEv100 = s.manualEv100,
            .compensation = s.compensation,
            .middleGrey = s.middleGrey,
            .minEv100 = s.minEv100,
            .maxEv100 = s.maxEv100,
            .lowShare = fixedPoint(s.lowPercentile),
            .highShare = fixedPoint(1.0 - s.highPercentile),
            .keepUp = keep(s.speedUp),
            .keepDown = keep(s.speedDown)};
}

} // namespace candelabra::exposure

void cndDefaultExposureSettings(CndExposureSettings* settings)
{
    *settings = {.manual = VK_FALSE,
                 .manualEv100 = 10, // EV100 of a lit interior
                 .compensation = 0,
                 .middleGrey = 0.18f,
                 .minEv100 = -6,
                 .maxEv100 = 18,
                 .lowPercentile = 0.10f,
                 .highPercentile = 0.90f,
                 .speedUp = 3,
                 .speedDown = 1,
                 .metering = CND_METERING_CENTRE_WEIGHTED,
                 .toneMap = CND_TONEMAP_PBR_NEUTRAL,
                 .dither = VK_TRUE};
}

float cndEv100FromCamera(float aperture, float shutterTime, float iso)
{
    return std::log2(aperture * aperture / shutterTime * 100 / iso);
}

float cndExposureFromEv100(float ev100, float middleGrey)
{
    return 8 * middleGrey / std::exp2(ev100);
}
