// SPDX-License-Identifier: Apache-2.0
// Measures how far a rendered image is from its truth.
#pragma once

#include <vector>

#include "io/image.h"
#include "io/report.h"
#include "measure/accuracy/flip.h"

namespace candelabra::app
{

struct WorstPixel {
    uint32_t x, y;
    double value, truth; // cd/m^2, the channel that differs most
};

// The differences of all channels of all pixels, where d = value - truth.
struct ImageDifference {
    double relMse = 0;      // mean of the squares of relativeErrors()
    double relL1 = 0;       // sum |d| / sum truth
    double maxOverPeak = 0; // largest |d| / largest truth
    double energy = 0;      // sum value / sum truth - 1
    // Over lit channels only (those whose truth is above 0.001 of its largest value): the mean of
    // (d / truth)^2, and the mean, the 99th percentile and the largest value of |d| / truth.
    double litRelMse = 0, litMeanRel = 0, litP99Rel = 0, litMaxRel = 0;
    // The mean of FLIP over the pixels of the displayed images. imageDifference leaves it 0.
    double flip = 0;
    size_t invalid = 0;            // values that are NaN or infinite, which count as 0
    std::vector<WorstPixel> worst; // the pixels with the largest |d|, the largest first
};

// The relative error of every value: |value - truth| / sqrt(truth^2 + 0.01 mean(truth)^2), so that
// dark values do not count too much. Both images hold as many values, all finite. Where the truth
// is black everywhere, an error is infinite.
std::vector<double> relativeErrors(const Image& value, const Image& truth);

// Both images have 3 channels and the same size.
ImageDifference imageDifference(const Image& value, const Image& truth);

// Both images as they are displayed: with the exposure metered on `truth` and the default tone map.
struct Displayed {
    DisplayImage truth, value;
};
Displayed displayBoth(const Image& truth, const Image& value);

Json toJson(const ImageDifference& error);

} // namespace candelabra::app
