// SPDX-License-Identifier: Apache-2.0
// How far a rendered image is from its truth.
#pragma once

#include <vector>

#include "candelabra/candelabra.h"
#include "io/image.h"
#include "io/report.h"
#include "measure/accuracy/flip.h"

namespace candelabra::app
{

struct WorstPixel {
    uint32_t x, y;
    double value, truth; // cd/m^2, the channel that differs most
};

// Of all channels of all pixels. d = value - truth.
struct ImageDifference {
    double relMse = 0; // mean of d^2 / (truth^2 + 0.01 mean(truth)^2)
    double relL1 = 0;  // sum |d| / sum truth
    double maxOverPeak = 0;
    double energy = 0; // sum value / sum truth - 1
    // Where truth > 0.001 of its largest value:
    double litRelMse = 0, litMeanRel = 0, litP99Rel = 0, litMaxRel = 0;
    double flip = 0;               // mean over the pixels, as displayed
    size_t invalid = 0;            // values that are NaN or infinite; counted as 0
    std::vector<WorstPixel> worst; // by |d|, largest first
};

// Both have 3 channels and one size.
ImageDifference imageDifference(const Image& value, const Image& truth);

// The images as an eye adapted to the first sees them: exposure metered on `truth`, default tone
// map. For both the same exposure.
struct Displayed {
    DisplayImage truth, value;
};
Displayed displayBoth(const Image& truth, const Image& value);

Json toJson(const ImageDifference& error);

} // namespace candelabra::app
