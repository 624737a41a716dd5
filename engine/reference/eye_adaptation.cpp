// SPDX-License-Identifier: Apache-2.0
#include "reference/eye_adaptation.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace candelabra::reference
{

namespace
{

constexpr int minExponent = -12; // lower edge of bin 0, log2 of cd/m^2
constexpr int maxExponent = 20;  // upper edge of bin 255
constexpr uint32_t binsPerOctave = 8;
constexpr uint32_t mantissaShift = 20; // leaves three bits of the mantissa: 2^3 = binsPerOctave
constexpr uint32_t fractionShift = 16; // the next four bits are the position within the bin
constexpr uint32_t fractions = 16;
constexpr uint32_t exponentBias = 127; // IEEE 754 binary32
static_assert(binsPerOctave * (maxExponent - minExponent) == CND_HISTOGRAM_BINS);

uint32_t pixelWeight(CndMetering metering, const ExposureMask& mask, uint32_t x, uint32_t y,
                     uint32_t width, uint32_t height)
{
    switch (metering) {
    case CND_METERING_AVERAGE:
        return 1;
    case CND_METERING_CENTRE_WEIGHTED:
        return centreWeight(x, y, width, height);
    case CND_METERING_MASK:
        return maskWeight(mask, x, y, width, height);
    default:
        throw std::invalid_argument("the metering mode is unknown");
    }
}

} // namespace

float histogramLuminance(float r, float g, float b)
{
    const float red = 0.2126f * r;
    const float green = 0.7152f * g;
    const float blue = 0.0722f * b;
    const float sum = red + green;
    return sum + blue;
}

std::optional<uint32_t> histogramBin(float luminance)
{
    if (std::isnan(luminance))
        return std::nullopt;
    if (luminance < std::ldexp(1.0f, minExponent))
        return 0;
    if (luminance >= std::ldexp(1.0f, maxExponent))
        return CND_HISTOGRAM_BINS - 1;
    // The exponent of a float and the top bits of its mantissa, read as one integer, number the
    // bins from 2^-127 on.
    const uint32_t bits = std::bit_cast<uint32_t>(luminance);
    return (bits >> mantissaShift) - (exponentBias + minExponent) * binsPerOctave;
}

uint32_t binFraction(float luminance)
{
    if (luminance < std::ldexp(1.0f, minExponent))
        return 0;
    if (luminance >= std::ldexp(1.0f, maxExponent))
        return fractions - 1;
    return std::bit_cast<uint32_t>(luminance) >> fractionShift & (fractions - 1);
}

double binLog2Luminance(uint32_t bin, double meanFraction)
{
    const double step = bin % binsPerOctave + (meanFraction + 0.5) / fractions;
    return minExponent + static_cast<int>(bin / binsPerOctave) +
           std::log2(1 + step / binsPerOctave);
}

uint32_t centreWeight(uint32_t x, uint32_t y, uint32_t width, uint32_t height)
{
    const int64_t w = width, h = height;
    const int64_t dx = std::abs(2 * int64_t{x} + 1 - w);
    const int64_t dy = std::abs(2 * int64_t{y} + 1 - h);
    const int64_t fall = 15 * std::max(dx * h, dy * w) / (w * h);
    return static_cast<uint32_t>(15 - std::min<int64_t>(14, fall));
}

uint32_t maskWeight(const ExposureMask& mask, uint32_t x, uint32_t y, uint32_t width,
                    uint32_t height)
{
    const uint64_t column = uint64_t{x} * mask.width / width;
    const uint64_t row = uint64_t{y} * mask.height / height;
    return mask.weights[row * mask.width + column];
}

Histogram buildHistogram(std::span<const float> rgba, uint32_t width, uint32_t height,
                         CndMetering metering, const ExposureMask& mask)
{
    if (rgba.size() != size_t{4} * width * height)
        throw std::invalid_argument("the image does not hold width * height pixels of 4 floats");
    if (metering == CND_METERING_MASK &&
        (mask.weights.empty() || mask.weights.size() != size_t{mask.width} * mask.height))
        throw std::invalid_argument("the metering mask does not hold width * height weights");
    Histogram histogram;
    const float* pixel = rgba.data();
    for (uint32_t y = 0; y < height; ++y) {
        for (uint32_t x = 0; x < width; ++x, pixel += 4) {
            const float luminance = histogramLuminance(pixel[0], pixel[1], pixel[2]);
            const auto bin = histogramBin(luminance);
            if (!bin) {
                ++histogram.invalidPixels;
                continue;
            }
            const uint32_t weight = pixelWeight(metering, mask, x, y, width, height);
            histogram.counts[*bin] += weight;
            if (luminance < std::numeric_limits<float>::min())
                histogram.blackWeight += weight;
            histogram.fractions[*bin] += uint64_t{weight} * binFraction(luminance);
        }
    }
    return histogram;
}

std::optional<double> percentileMeanLog2(const Histogram& histogram, double low, double high)
{
    double total = 0; // at most 15 * 2^28, which is exact in double
    for (const uint32_t count : histogram.counts)
        total += count;
    const double black = histogram.blackWeight < total ? histogram.blackWeight : 0;
    total -= black;
    const double first = low * total;
    const double last = high * total;
    double below = 0, mass = 0, sum = 0;
    for (uint32_t bin = 0; bin < CND_HISTOGRAM_BINS; ++bin) {
        const double count = histogram.counts[bin] - (bin == 0 ? black : 0);
        const double above = below + count;
        const double inside = std::min(above, last) - std::max(below, first);
        if (inside > 0) {
            const double meanFraction = double(histogram.fractions[bin]) / count;
            mass += inside;
            sum += inside * binLog2Luminance(bin, meanFraction);
        }
        below = above;
    }
    return mass > 0 ? std::optional(sum / mass) : std::nullopt;
}

double exposureFromEv100(double ev100, double compensation, double middleGrey)
{
    const double luminance = std::exp2(ev100 - compensation) * 12.5 / 100;
    return middleGrey / luminance;
}

Adaptation adapt(const Histogram& histogram, const CndExposureSettings& settings,
                 double previousEv100, double deltaTime, bool reset)
{
    if (settings.manual) {
        const double ev = settings.manualEv100;
        return {ev, ev, exposureFromEv100(ev, settings.compensation, settings.middleGrey)};
    }
    const auto clampEv = [&](double ev) {
        return std::clamp<double>(ev, settings.minEv100, settings.maxEv100);
    };
    const std::optional<double> mean =
        percentileMeanLog2(histogram, settings.lowPercentile, settings.highPercentile);
    // EV100 = log2(L * 100 / 12.5), ISO 2720 with K = 12.5.
    const double ev = mean ? *mean + std::log2(100 / 12.5) : reset ? 0.0 : previousEv100;
    Adaptation result;
    result.targetEv100 = clampEv(ev);
    const double start = reset ? result.targetEv100 : previousEv100;
    const double speed = result.targetEv100 > start ? settings.speedUp : settings.speedDown;
    result.adaptedEv100 =
        clampEv(result.targetEv100 + (start - result.targetEv100) * std::exp(-deltaTime * speed));
    result.exposure =
        exposureFromEv100(result.adaptedEv100, settings.compensation, settings.middleGrey);
    return result;
}

} // namespace candelabra::reference
