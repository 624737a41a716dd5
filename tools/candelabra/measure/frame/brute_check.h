// SPDX-License-Identifier: Apache-2.0
// Compares clustered lighting with brute force, which uses no list, no bound and no early exit.
#pragma once

#include <functional>
#include <vector>

#include "io/image.h"
#include "render/renderer.h"

namespace candelabra::app
{

enum class CheckExtent {
    Auto,    // all pixels up to 16,384 lights, a sample of tiles with more lights
    Sampled, // a sample of tiles, a fifth as many: some seconds on two CPU cores
    Full,    // all pixels
    None,    // no pixel
};

struct BruteCheck {
    uint64_t pixels = 0; // pixels compared; 0: no check was made
    size_t rects = 0;    // rectangles that hold them
    bool allPixels = false;
    double maxRadiance = 0; // cd/m^2, the largest finite channel of the clustered image
    double maxDifference =
        0;              // cd/m^2, the largest of any channel; infinite if a value is not finite
    double bruteMs = 0; // GPU time of brute-force shading of the compared pixels

    double relative() const { return maxRadiance > 0 ? maxDifference / maxRadiance : 0; }
    // Bound of the difference relative to the largest radiance. Clustering promises to lose
    // nothing: the sums are the same but for their order, and sums of some hundred lights in float
    // differ by no more.
    static constexpr double bound = 1e-6;
    bool passed() const { return maxDifference <= bound * maxRadiance; }
};

// The number of (pixel, light) pairs that a sampled check evaluates. Two CPU cores evaluate some
// 200 million a second, which makes less than a minute for Auto and five seconds for Sampled. At
// least minSampledTiles tiles are compared, and all pixels where they have no more pairs than that.
constexpr uint64_t sampledPairs = 5'000'000'000;
constexpr uint64_t quickSampledPairs = sampledPairs / 5;
constexpr uint32_t minSampledTiles = 16;
// The side of a sampled tile in pixels. A tile is four workgroups, so that it keeps more than one
// CPU core busy.
constexpr uint32_t sampledTile = 16;

// Returns the pixels that a check compares, as rectangles that do not overlap: tiles, or bands of
// as many rows as one submission should shade, but at least 8.
std::vector<VkRect2D> checkRects(PixelSize size, uint64_t lights, CheckExtent extent);

// Shades the rectangles by brute force and compares them with `clustered`, the image that
// `renderer` has made of `options`. `onPairs` is called with the number of (pixel, light) pairs
// that were just done.
BruteCheck compareWithBruteForce(const VulkanContext& context, Renderer& renderer,
                                 const FrameOptions& options, const Image& clustered,
                                 const std::vector<VkRect2D>& rects, uint64_t lights,
                                 const std::function<void(double)>& onPairs);

} // namespace candelabra::app
