// SPDX-License-Identifier: Apache-2.0
// Attributes the time of shading to single lights.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "io/report.h"
#include "io/table.h"
#include "reference/surface.h"
#include "render/renderer.h"

namespace candelabra::app
{

struct LightCost {
    uint32_t light = 0;  // index in the scene
    uint64_t pixels = 0; // pixels whose surface is within its influence and can be lit by it
    double pairs = 0;    // its share of the evaluated (pixel, light) pairs
};

struct LightCosts {
    std::vector<LightCost> lights; // the costliest first; only lights that cover a pixel
    uint64_t surfaces = 0;         // pixels that show a surface
    uint64_t coveredPairs = 0;     // the sum of LightCost::pixels
    double pairs = 0;              // pairs evaluated, including lanes that wait for others
    double time = 0;               // of the frame, in s
    double others = 0;             // those pairs in tiles of 8x8 pixels that no light covers
};

// The pairs that were evaluated at every pixel of a frame.
struct PairImage {
    PixelSize size;
    std::vector<float> evaluated; // per pixel, rows from the top
    std::function<std::optional<reference::SurfacePoint>(uint32_t x, uint32_t y)> pointAt;
};

// Distributes the pairs of each tile among the lights in proportion to the tile's pixels that they
// cover: the lanes of a tile wait for each other, so that a light costs time also at pixels on
// which it does not shine. Lights on other layers than the camera's are on no list and cover
// nothing. Positions of lights are relative to `origin`.
LightCosts shareOut(const PairImage& image, const std::vector<CndLight>& lights,
                    const glm::dvec3& origin, const Camera& camera);

// Draws one more clustered frame like `frame`, counts its pairs per pixel, and attributes them to
// lights.
LightCosts lightCosts(const VulkanContext& context, Renderer& renderer, const Scene& scene,
                      const FrameOptions& frame);

// Draws one more clustered frame like `frame`, and counts its pairs as LightCosts::pairs.
uint64_t evaluatedPairs(const VulkanContext& context, Renderer& renderer,
                        const FrameOptions& frame);

// Names some of `all` lights by their indices: "lights 7, 12, 31, ... (10 of 4,000)".
std::string namesOfLights(const std::vector<uint32_t>& lights, size_t all);

// A table of the `count` costliest lights and of what the others take, with their shares of
// `shadingMs`.
Table lightCostTable(const LightCosts& costs, const Scene& scene, size_t count, double shadingMs);
Json lightCostJson(const LightCosts& costs, const Scene& scene, size_t count, double shadingMs);

} // namespace candelabra::app
