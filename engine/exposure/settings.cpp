// SPDX-License-Identifier: Apache-2.0
// Defaults, ranges and camera arithmetic of the exposure module.
#include <cmath>
#include <string>

#include "exposure/exposure.h"

namespace candelabra::exposure
{
namespace
{

void require(bool condition, const char* sentence)
{
    if (!condition)
        gpu::failArgument(sentence);
}

} // namespace

void validateSettings(const CndExposureSettings& s)
{
    for (const float ev : {s.manualEv100, s.compensation, s.minEv100, s.maxEv100})
        require(std::isfinite(ev) && std::abs(ev) <= 64,
                "CndExposureSettings: manualEv100, compensation, minEv100 and maxEv100 must be "
                "finite and within +-64");
    require(s.minEv100 <= s.maxEv100, "CndExposureSettings: minEv100 must not exceed maxEv100");
    require(s.lowPercentile >= 0 && s.lowPercentile < s.highPercentile && s.highPercentile <= 1,
            "CndExposureSettings: percentiles must satisfy 0 <= low < high <= 1");
    require(s.speedUp > 0 && std::isfinite(s.speedUp) && s.speedDown > 0 &&
                std::isfinite(s.speedDown),
            "CndExposureSettings: speedUp and speedDown must be finite and > 0");
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

} // namespace candelabra::exposure

void cndDefaultExposureSettings(CndExposureSettings* settings)
{
    *settings = {.manual = VK_FALSE,
                 .manualEv100 = 10, // a lit interior at ISO 100
                 .compensation = 0,
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

float cndExposureFromEv100(float ev100)
{
    return 1 / (1.2f * std::exp2(ev100));
}
