// SPDX-License-Identifier: Apache-2.0
// Which lights take the time of shading.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "io/report.h"
#include "reference/surface.h"
#include "render/renderer.h"

namespace candelabra::app
{

struct LightCost {
    uint32_t light = 0;  // index in the scene
    uint64_t pixels = 0; // surfaces within its influence that it can shine on
    double pairs = 0;    // its part of the evaluated (pixel, light) pairs
};

struct LightCosts {
    std::vector<LightCost> lights; // costliest first; only those that cover a pixel
    uint64_t surfaces = 0;         // pixels that show one
    uint64_t coveredPairs = 0;     // sum of LightCost::pixels
    double pairs = 0;              // evaluated ones, lanes that wait for others included
    double others = 0;             // of those, in 8x8 tiles that no light covers
};

// A frame as it was shaded.
struct PairImage {
    PixelSize size;
    std::vector<float> evaluated; // pairs of every pixel, rows from the top
    std::function<std::optional<reference::SurfacePoint>(uint32_t x, uint32_t y)> pointAt;
};

// The pairs of a tile are shared out among the lights by the pixels of it that they cover: lanes of
// a tile wait for each other, so a light is paid for where it does not shine, too. Lights of other
// layers than the camera's are in no list: they cover nothing. `origin`: of the lights' positions.
LightCosts shareOut(const PairImage& image, const std::vector<CndLight>& lights,
                    const glm::dvec3& origin, const Camera& camera);

// Of one more frame like `frame`, clustered, which is drawn with its pairs counted per pixel.
LightCosts lightCosts(const VulkanContext& context, Renderer& renderer, const Scene& scene,
                      const FrameOptions& frame);

// The `count` costliest and what the others take, with their part of `shadingMs`.
std::string lightCostTable(const LightCosts& costs, const Scene& scene, size_t count,
                           double shadingMs);
Json lightCostJson(const LightCosts& costs, const Scene& scene, size_t count, double shadingMs);

} // namespace candelabra::app
