// SPDX-License-Identifier: Apache-2.0
// Compares clustered lighting with brute force, which shares no list, bound or early-out with it.
#pragma once

#include <functional>
#include <vector>

#include "io/image.h"
#include "render/renderer.h"

namespace candelabra::app
{

enum class CheckExtent {
    Auto,    // all pixels up to 16384 lights, beyond that sampled tiles
    Sampled, // sampled tiles, a fifth as many: some seconds on two CPU cores
    Full,
    None,
};

struct BruteCheck {
    uint64_t pixels = 0; // compared; 0: no check was made
    size_t rects = 0;    // that hold them
    bool allPixels = false;
    double maxRadiance = 0;   // cd/m^2, largest channel of the clustered image
    double maxDifference = 0; // cd/m^2, largest of any channel; infinite when a value is not finite
    double bruteMs = 0;       // GPU time of brute-force shading of those pixels

    double relative() const { return maxRadiance > 0 ? maxDifference / maxRadiance : 0; }
    // The bound of the promise that clustering loses nothing: order of summation aside, the sums
    // are the same, and float sums of some hundred lights differ by no more.
    static constexpr double bound = 1e-6;
    bool passed() const { return maxDifference <= bound * maxRadiance; }
};

// How many (pixel, light) pairs a sampled check evaluates. Two CPU cores evaluate some 200 million
// a second, which makes less than a minute for Auto and five seconds for Sampled. At least
// minSampledTiles tiles are compared, and all pixels where they have no more pairs than that.
constexpr uint64_t sampledPairs = 5'000'000'000;
constexpr uint64_t quickSampledPairs = sampledPairs / 5;
constexpr uint32_t minSampledTiles = 16;
// Pixels a side: four workgroups, so that one tile keeps more than one CPU core busy.
constexpr uint32_t sampledTile = 16;

// The pixels a check looks at: rectangles that do not overlap, none larger than one submission
// should be.
std::vector<VkRect2D> checkRects(PixelSize size, uint64_t lights, CheckExtent extent);

// `clustered` is what `renderer` made of `options`. `onPairs` hears how many (pixel, light) pairs
// were just done.
BruteCheck compareWithBruteForce(const VulkanContext& context, Renderer& renderer,
                                 const FrameOptions& options, const Image& clustered,
                                 const std::vector<VkRect2D>& rects, uint64_t lights,
                                 const std::function<void(double)>& onPairs);

} // namespace candelabra::app
