// SPDX-License-Identifier: Apache-2.0
// CPU reference of the histogram eye adaptation in candelabra.h. Bins, weights and counts are exact
// by construction (float32 products in a fixed order, bit patterns, integers), so that a GPU must
// match them to the last count. Everything after the histogram is in double precision.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "candelabra/candelabra.h"

namespace candelabra::reference
{

// Luminance of a linear Rec.709 colour with the weights of ITU-R BT.709, in float32 and in this
// order: ((0.2126 r) + (0.7152 g)) + (0.0722 b), no product fused into a sum.
float histogramLuminance(float r, float g, float b);

// Returns the bin of a luminance; empty for NaN. Eight bins of equal width per octave, 32 octaves
// from 2^-12 to 2^20 cd/m^2. Lower luminances (also zero, negative and -infinity) are in bin 0,
// higher ones (also +infinity) in bin 255.
std::optional<uint32_t> histogramBin(float luminance);

// Returns where in its bin a luminance lies, in sixteenths of the bin's interval, rounded down; 0
// below the range and 15 above it. Not for NaN.
uint32_t binFraction(float luminance);

// Returns log2 of the luminance at `meanFraction` sixteenths (0..15) of a bin's interval, plus half
// a sixteenth, which is the average of what rounding down removed.
double binLog2Luminance(uint32_t bin, double meanFraction);

// Returns the weight of pixel (x, y): 15 - min(14, 15 max(dx height, dy width) / (width height))
// with integer division, where dx = |2x + 1 - width| and dy = |2y + 1 - height|. The products fit
// 32 bits up to 16384 x 16384 pixels.
uint32_t centreWeight(uint32_t x, uint32_t y, uint32_t width, uint32_t height);

// A metering mask as for cndSetExposureMask: width x height weights, rows from the top.
struct ExposureMask {
    std::span<const uint8_t> weights;
    uint32_t width = 0, height = 0;
};

// Returns the weight of pixel (x, y): mask[(y maskHeight) / height][(x maskWidth) / width].
uint32_t maskWeight(const ExposureMask& mask, uint32_t x, uint32_t y, uint32_t width,
                    uint32_t height);

struct Histogram {
    std::array<uint32_t, CND_HISTOGRAM_BINS> counts{};    // sums of weights
    std::array<uint64_t, CND_HISTOGRAM_BINS> fractions{}; // sums of weight * binFraction
    // The part of counts[0] from pixels without any light (luminance below the smallest normal
    // float). It is left out of the mean unless there are no other pixels.
    uint32_t blackWeight = 0;
    uint32_t invalidPixels = 0; // pixels with NaN luminance, whatever their weight; they are in no
                                // bin
};

// `rgba` holds width * height pixels of four floats, rows from the top; the fourth float is
// ignored. `mask` is read only with CND_METERING_MASK. Throws std::invalid_argument when a size is
// wrong.
Histogram buildHistogram(std::span<const float> rgba, uint32_t width, uint32_t height,
                         CndMetering metering, const ExposureMask& mask = {});

// Returns the mean of log2 luminance over the part of the weighted histogram between the shares
// `low` and `high`. A bin that straddles a border counts with the fraction that lies inside. Empty
// if there are no counts.
std::optional<double> percentileMeanLog2(const Histogram& histogram, double low, double high);

struct Adaptation {
    double targetEv100 = 0;  // metered, or manualEv100
    double adaptedEv100 = 0; // the history for the next frame
    double exposure = 0;     // factor on luminance, compensation included
};

// Computes one frame.
//
// Automatic: target = mean log2 luminance + log2(100 / 12.5), clamped to [minEv100, maxEv100];
// adapted = target + (previous - target) exp(-deltaTime speed), clamped to the same range (which
// matters only when the range has changed). An empty histogram keeps the previous value, or EV 0
// (clamped) with `reset`. `reset` jumps to the target.
//
// Manual: target and adapted value are manualEv100, not clamped.
Adaptation adapt(const Histogram& histogram, const CndExposureSettings& settings,
                 double previousEv100, double deltaTime, bool reset);

// Returns the factor that gives the luminance of EV100 `ev100 - compensation`, 2^EV100 * 12.5 / 100
// cd/m^2, the exposed value `middleGrey`.
double exposureFromEv100(double ev100, double compensation, double middleGrey);

} // namespace candelabra::reference
