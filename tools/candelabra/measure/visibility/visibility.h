// SPDX-License-Identifier: Apache-2.0
// Measures what soft shadows cost and how exact they are, beside rays as rivals.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "io/progress.h"
#include "io/report.h"
#include "io/statistics.h"
#include "reference/render.h"
#include "render/renderer.h"

namespace candelabra::app
{

struct VisibilitySettings {
    FrameOptions frame;      // with shadows
    uint32_t rounds = 1;     // of frames with and without shadows
    uint32_t pixels = 1;     // at random positions, compared with the truth
    bool pictures = false;   // see VisibilityErrors
    double tolerance = 1e-4; // reference::TruthOptions::relative
};

struct ErrorSpread {
    double mean = 0;
    Spread spread;
};

// Errors of the luminance of pixels.
struct VisibilityError {
    std::string name;
    std::optional<int> rays;  // per pair of a pixel and a light, in place of the engine's points
    ErrorSpread ofPixel;      // relative to the truth, where it has light
    ErrorSpread ofUnshadowed; // relative to the truth without shadows, also in full shadow
};

struct VisibilityErrors {
    std::vector<VisibilityError> rows; // of this engine, without shadows, and of rays
    size_t compared = 0;               // pixels that lights reach, but for shadows
    size_t leaks = 0; // of them, pixels without light, by the truth, that the engine gives light
    // The frame, and the truth and the rivals at the pixels compared, NaN elsewhere; by their
    // names.
    std::vector<std::pair<std::string, Image>> pictures;
};

struct VisibilityCost {
    CndLightingStats stats{}; // with counted pairs
    // Medians of the passes prove_dark, ask_pairs, list_occluders and pair_visibility.
    double proveMs = 0, askMs = 0, listMs = 0, visibilityMs = 0;
    double rayMs = 0;  // time of a ray (measureRayMs); 0: not known
    double cpuMs = 0;  // CPU time that a frame takes with shadows, less that without
    PairedRatio ratio; // GPU time with shadows over that without
};

VisibilityCost measureVisibilityCost(const VulkanContext& context, Renderer& renderer,
                                     const VisibilitySettings& settings, Progress& progress);

// Returns the scene with a point light of the same luminous power in place of each light that has a
// size, and a directional light in place of each distant sphere.
Scene withPointLights(Scene scene);

// Returns the time of pair_visibility per pair that asks, in milliseconds; 0 if no pair asks. In a
// scene withPointLights(), that is what a ray takes.
double measureRayMs(const VulkanContext& context, Renderer& pointLights,
                    const VisibilitySettings& settings, Progress& progress);

// Returns the errors of the renderer's frame and those of rivals: the truth of each light without
// shadows, multiplied by the share of rays that reach it, and without rays all of it. `model`: the
// scene that the renderer draws, seen by the camera of the frame.
VisibilityErrors measureVisibilityErrors(const VulkanContext& context, Renderer& renderer,
                                         const reference::Scene& model,
                                         const VisibilitySettings& settings, Progress& progress);

// What the progress of these functions counts.
double visibilitySteps(const VisibilitySettings& settings);

std::string visibilityText(const VisibilityCost& cost, const VisibilityErrors& errors,
                           PixelSize size);
Json visibilityJson(const VisibilityCost& cost, const VisibilityErrors& errors);

} // namespace candelabra::app
