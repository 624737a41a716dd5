// SPDX-License-Identifier: Apache-2.0
// Measures how much two pictures from files differ, which may hold NaN.
#pragma once

#include <cstdint>
#include <vector>

#include "io/image.h"
#include "render/legend.h"

namespace candelabra::app
{

// Where the values of two pictures differ most.
struct LargestDifference {
    uint32_t x = 0, y = 0;
    uint32_t channel = 0; // red, green, blue
    double a = 0, b = 0;
};

struct PictureDifference {
    bool sameBits = false;
    uint64_t pixels = 0;                     // those that differ; NaN equals NaN, and 0 equals -0
    uint64_t notFinitePixels = 0;            // those of them with a value that is NaN or infinite
    uint64_t notFiniteA = 0, notFiniteB = 0; // pixels of each picture with such a value
    // The measures leave out pixels with such a value in either picture. They are 0 if no pixels
    // are left.
    double relMse = 0;              // the mean of the squares of relativeErrors() (image_error.h)
    double meanRel = 0, p99Rel = 0; // their mean and 99th percentile over the channels of pixels
    LargestDifference largest;
    std::vector<float> errors; // of each pixel, its largest channel; NaN for notFinitePixels
};

// Both have 3 channels and the same size. `b` is the reference.
PictureDifference pictureDifference(const Image& a, const Image& b);

// The mean of FLIP (flip.h). Linear pictures are displayed first (displayBoth). Pixels with NaN or
// infinite values in either are black in both.
double pictureFlip(Image a, Image b, bool linear);

// The map of PictureDifference::errors in the colours of heat maps, with a legend below it. The
// colours have a logarithmic scale from 0.01% or less to 100% or more. Equal pixels are black, and
// errors that are NaN white.
Legend errorMap(const std::vector<float>& errors, uint32_t width, uint32_t height);

} // namespace candelabra::app
