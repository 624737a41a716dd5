// SPDX-License-Identifier: Apache-2.0
// CPU reference of the histogram eye adaptation in candelabra.h. Bins, weights and counts are exact
// by construction (float32 products in a fixed order, bit patterns, integers), so that a GPU must
// match them to the last count; what follows the histogram is in double.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "candelabra/candelabra.h"

namespace candelabra::reference
{

// Luminance of a linear Rec.709 colour, ITU-R BT.709 weights, in float32 and in this order:
// ((0.2126 r) + (0.7152 g)) + (0.0722 b), no product fused into a sum.
float histogramLuminance(float r, float g, float b);

// Bin of a luminance; empty for NaN. Eight bins per octave of equal width inside the octave, over
// 32 octaves from 2^-12 to 2^20 cd/m^2. Everything below (zero, negative, -infinity) is in bin 0,
// everything above (+infinity) in bin 255.
std::optional<uint32_t> histogramBin(float luminance);

// Where in its bin a luminance lies, in sixteenths of the bin's interval, rounded down; 0 below the
// range and 15 above. Not for NaN.
uint32_t binFraction(float luminance);

// log2 of the luminance at `meanFraction` sixteenths (0..15) of a bin's interval, plus half a
// sixteenth: what the members of the bin have on average.
double binLog2Luminance(uint32_t bin, double meanFraction);

// Weight of pixel (x, y): with dx = |2x + 1 - width| and dy = |2y + 1 - height|,
// 15 - min(14, 15 max(dx height, dy width) / (width height)), integer division. Fits 32 bits up to
// 16384 x 16384.
uint32_t centreWeight(uint32_t x, uint32_t y, uint32_t width, uint32_t height);

// Metering mask as for cndSetExposureMask: width x height weights from the top.
struct ExposureMask {
    std::span<const uint8_t> weights;
    uint32_t width = 0, height = 0;
};

// Weight of pixel (x, y): mask[(y maskHeight) / height][(x maskWidth) / width].
uint32_t maskWeight(const ExposureMask& mask, uint32_t x, uint32_t y, uint32_t width,
                    uint32_t height);

struct Histogram {
    std::array<uint32_t, CND_HISTOGRAM_BINS> counts{};    // sums of weights
    std::array<uint64_t, CND_HISTOGRAM_BINS> fractions{}; // sums of weight * binFraction
    // The part of counts[0] without any light (luminance below the smallest normal float): left out
    // of the mean unless there is nothing else.
    uint32_t blackWeight = 0;
    uint32_t invalidPixels = 0; // NaN luminance, whatever its weight; in no bin
};

// `rgba` holds width * height pixels of four floats, rows from the top; the fourth is ignored.
// `mask` is read by CND_METERING_MASK only. Throws std::invalid_argument when a size is wrong.
Histogram buildHistogram(std::span<const float> rgba, uint32_t width, uint32_t height,
                         CndMetering metering, const ExposureMask& mask = {});

// Mean of log2 luminance over the part of the weighted histogram between the shares `low` and
// `high`; a bin on a border counts with the fraction of it that lies inside. Empty without counts.
std::optional<double> percentileMeanLog2(const Histogram& histogram, double low, double high);

struct Adaptation {
    double targetEv100 = 0;  // of the histogram, or manualEv100
    double adaptedEv100 = 0; // the history for the next frame
    double exposure = 0;     // factor on luminance, compensation included
};

// One frame. Automatic: target = mean log2 luminance + log2(100 / 12.5), clamped to
// [minEv100, maxEv100]; adapted = target + (previous - target) exp(-deltaTime speed), clamped
// likewise (which matters only when the range has moved). An empty histogram keeps the previous
// value, or EV 0 (clamped) with `reset`. `reset` jumps to the target.
// Manual: both are manualEv100, unclamped.
Adaptation adapt(const Histogram& histogram, const CndExposureSettings& settings,
                 double previousEv100, double deltaTime, bool reset);

// 1 / (1.2 * 2^(ev100 - compensation)); Lagarde and de Rousiers 2014, eq. 85.
double exposureFromEv100(double ev100, double compensation);

} // namespace candelabra::reference
