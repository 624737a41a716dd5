// SPDX-License-Identifier: Apache-2.0
// Searches the largest number of lights that can be drawn in a given time. It knows nothing of what
// is measured, and expects that other programs sometimes make a measured time too long.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace candelabra::app
{

struct LightTime {
    uint32_t lights = 0;
    double ms = 0;
};

struct LightSearchRange {
    double ms = 0;      // the time that a frame may take
    uint32_t start = 1; // the number to try first
    uint32_t most = 1;  // the largest number to try
};

struct LightSearch {
    // In ascending order. A number that was measured again has the shortest time, because other
    // programs only make times longer.
    std::vector<LightTime> tried;
    std::optional<uint32_t> lights; // the largest number tried that is fast enough, if any
    bool isMost = false;            // it is LightSearchRange::most
};

// The search ends after so many measurements, or when the frame takes this share of its time.
constexpr uint32_t maxSearched = 12;
constexpr double filledShare = 0.97;

// `msOf(lights)` measures the time of a frame, or returns nothing if no scene has so few lights.
LightSearch searchLights(const LightSearchRange& range,
                         const std::function<std::optional<double>(uint32_t)>& msOf);

// Returns the number of lights that take `ms`, interpolated between those tried. Nothing if none of
// them was slower or none as fast.
std::optional<uint32_t> lightsWithin(std::span<const LightTime> tried, double ms);

// Rounds a number down to so many significant digits.
uint32_t roundedDown(double value, int digits);

} // namespace candelabra::app
