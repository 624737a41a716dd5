// SPDX-License-Identifier: Apache-2.0
// Sentences about the number of lights that a frame rate allows, and about what takes the time.
#pragma once

#include <string>

#include "io/parse.h"
#include "measure/light_search.h"

namespace candelabra::app
{

// What a frame with a number of lights costs, in GPU time.
struct FrameCost {
    uint32_t lights = 0; // as the user counts them
    double ms = 0, lightingMs = 0, rasterMs = 0;
    double lightsPerPixel = 0;

    double restMs() const { return ms - lightingMs - rasterMs; }
    double framesPerSecond() const { return 1000 / ms; }
};

// The condition of all figures.
struct FrameCondition {
    std::string scene, device;
    PixelSize size;
    uint32_t shadows = 0;
    bool addedLights = false; // the scene has lights besides those counted
};

// "at 16,000 sphere lights: 3.1 frames/s (...); lighting ...". `cost.ms` is 0 if the device has no
// timestamps.
std::string costSentence(const FrameCost& cost, const FrameCondition& condition);

// "53,000 sphere lights at 60 frames/s (...): lighting ...". `cost` is that of the number found, or
// of the smallest one tried if none was fast enough. `fewest` says why fewer were not tried; empty
// if it is one.
std::string searchSentence(double framesPerSecond, const LightSearch& search, const FrameCost& cost,
                           const FrameCondition& condition, const std::string& fewest);

} // namespace candelabra::app
