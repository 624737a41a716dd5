// SPDX-License-Identifier: Apache-2.0
// Renders frames of a scene and collects what is worth reporting about them.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "io/report.h"
#include "render/pass_times.h"
#include "render/renderer.h"

namespace candelabra::app
{

// Scene time between two frames of a moving scene.
constexpr double frameTime = 1.0 / 60; // s

struct FrameCounts {
    // Drawn before the measured ones and like the first of them, not measured: the first frame of
    // a pipeline includes its compilation.
    uint32_t warmUp = 1;
    uint32_t measured = 1;
};

struct MeasuredFrames {
    PassTimes times;
    FrameStats last;
};

// All frames go through two slots of a frame ring. Warm-up frames and the first measured one show
// `options`; with `moving`, later ones are frameTime apart and exposure adapts, else all are the
// same. With a converged exposure (resetExposure), warm-up frames leave no trace in any image.
// `onFrame` is called after each. Returns when the GPU is done.
MeasuredFrames renderFrames(const VulkanContext& context, Renderer& renderer,
                            const FrameOptions& options, FrameCounts counts, bool moving,
                            const std::function<void()>& onFrame);

// One more frame like `options`, with its (pixel, light) pairs counted.
CndLightingStats countPairs(const VulkanContext& context, Renderer& renderer, FrameOptions options);

std::string passTable(const PassTimes& times);
// Lights by type, and every pass with why it was skipped, a line each.
std::string planText(const FrameStats& frame);

Json toJson(const PassTimes& times);
Json toJson(const std::vector<CndPassPlan>& plan);
Json toJson(const CndLightingStats& stats); // pairs are 0 when they were not counted
Json toJson(const CndExposureStats& stats);
Json toJson(const FrameOptions& options, CndGBufferLayout layout);
Json sceneJson(const Scene& scene, const Renderer& renderer);

} // namespace candelabra::app
