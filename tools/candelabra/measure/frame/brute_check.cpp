// SPDX-License-Identifier: Apache-2.0
#include "measure/frame/brute_check.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "render/readback.h"

namespace candelabra::app
{
namespace
{

constexpr uint64_t fullCheckLights = 16384;
// As many pairs take about two seconds on two CPU cores and milliseconds on a GPU, which no
// watchdog of a driver interrupts.
constexpr uint64_t pairsPerSubmission = 500'000'000;
constexpr uint32_t workgroup = 8; // pixels a side

VkRect2D rect(uint32_t x, uint32_t y, uint32_t width, uint32_t height)
{
    return {{int32_t(x), int32_t(y)}, {width, height}};
}

std::vector<VkRect2D> bands(PixelSize size, uint64_t lights)
{
    const uint64_t perRow = std::max<uint64_t>(size.width * lights, 1);
    const uint64_t rows = std::clamp<uint64_t>(pairsPerSubmission / perRow / workgroup * workgroup,
                                               workgroup, size.height);
    std::vector<VkRect2D> out;
    for (uint64_t y = 0; y < size.height; y += rows)
        out.push_back(
            rect(0, uint32_t(y), size.width, uint32_t(std::min<uint64_t>(rows, size.height - y))));
    return out;
}

// Returns tiles that are spread evenly and hold about this many (pixel, light) pairs: multiples of
// the golden ratio, modulo 1, fill an interval without gaps or clumps.
std::vector<VkRect2D> sampledTiles(PixelSize size, uint64_t lights, uint64_t pairs)
{
    constexpr uint32_t tile = sampledTile;
    const uint32_t columns = (size.width + tile - 1) / tile, rows = (size.height + tile - 1) / tile;
    const uint64_t total = uint64_t(columns) * rows;
    const uint64_t wanted = std::max<uint64_t>(pairs / (tile * tile * lights), minSampledTiles);
    if (wanted >= total)
        return bands(size, lights);
    constexpr double golden = 0.6180339887498949;
    std::vector<bool> taken(total);
    std::vector<VkRect2D> out;
    for (uint64_t i = 0; out.size() < wanted; ++i) {
        double whole = 0;
        uint64_t index = uint64_t(std::modf(double(i) * golden, &whole) * double(total));
        while (taken[index]) // rarely, the sequence comes to a tile for the second time
            index = (index + 1) % total;
        taken[index] = true;
        const uint32_t x = uint32_t(index % columns) * tile, y = uint32_t(index / columns) * tile;
        out.push_back(rect(x, y, std::min(tile, size.width - x), std::min(tile, size.height - y)));
    }
    return out;
}

// The largest finite channel. Infinite ones are left out, because one infinite pixel would make
// every difference look small.
double maxChannel(const Image& image)
{
    double out = 0;
    for (const float x : image.pixels)
        if (std::isfinite(x))
            out = std::max(out, double(x));
    return out;
}

double maxDifference(const Image& a, const Image& b, const VkRect2D& r)
{
    double out = 0;
    for (uint32_t row = 0; row < r.extent.height; ++row) {
        const size_t start =
            (size_t(r.offset.y + row) * a.width + uint32_t(r.offset.x)) * a.channels;
        for (size_t i = start; i < start + size_t(r.extent.width) * a.channels; ++i) {
            const double difference = std::abs(double(a.pixels[i]) - double(b.pixels[i]));
            if (!std::isfinite(difference))
                return std::numeric_limits<double>::infinity();
            out = std::max(out, difference);
        }
    }
    return out;
}

double shadingMs(const CndLightingStats& stats)
{
    double ms = 0;
    for (const PassTime& pass : passesOf({stats.kernelTimes, stats.kernelTimeCount}))
        ms += pass.name == "shade_brute" ? pass.ms : 0;
    return ms;
}

} // namespace

std::vector<VkRect2D> checkRects(PixelSize size, uint64_t lights, CheckExtent extent)
{
    if (extent == CheckExtent::None || !lights)
        return {};
    if (extent == CheckExtent::Sampled)
        return sampledTiles(size, lights, quickSampledPairs);
    if (extent == CheckExtent::Full || lights <= fullCheckLights)
        return bands(size, lights);
    return sampledTiles(size, lights, sampledPairs);
}

BruteCheck compareWithBruteForce(const VulkanContext& context, Renderer& renderer,
                                 const FrameOptions& options, const Image& clustered,
                                 const std::vector<VkRect2D>& rects, uint64_t lights,
                                 const std::function<void(double)>& onPairs)
{
    BruteCheck out{.rects = rects.size(), .maxRadiance = maxChannel(clustered)};
    if (rects.empty())
        return out;
    context.submitAndWait([&](VkCommandBuffer cmd) { renderer.recordUnlit(cmd, options); });
    for (const VkRect2D& r : rects) {
        context.submitAndWait(
            [&](VkCommandBuffer cmd) { renderer.recordBruteRect(cmd, options, r); });
        out.bruteMs += shadingMs(renderer.lightingStats(0));
        const uint64_t pixels = uint64_t(r.extent.width) * r.extent.height;
        out.pixels += pixels;
        onPairs(double(pixels) * double(lights));
    }
    context.submitAndWait([&](VkCommandBuffer cmd) { renderer.recordBruteEnd(cmd); });
    const Image brute = readRadiance(context, renderer);
    for (const VkRect2D& r : rects)
        out.maxDifference = std::max(out.maxDifference, maxDifference(clustered, brute, r));
    out.allPixels = out.pixels == uint64_t(clustered.width) * clustered.height;
    return out;
}

} // namespace candelabra::app
