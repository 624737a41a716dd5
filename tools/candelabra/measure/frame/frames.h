// SPDX-License-Identifier: Apache-2.0
// Renders frames of a scene, and reports their times and statistics as text and as JSON.
#pragma once

#include <functional>
#include <string>

#include "io/report.h"
#include "render/pass_times.h"
#include "render/renderer.h"

namespace candelabra::app
{

// Scene time between two frames of a moving scene, in seconds.
constexpr double frameTime = 1.0 / 60;

struct FrameCounts {
    // Frames drawn before the measured ones. They are like the first measured frame, and are not
    // measured, because the first frame of a pipeline includes its compilation.
    uint32_t warmUp = 1;
    uint32_t measured = 1;
    // More warm-up frames are drawn for so many seconds, because the clock of a GPU that was idle
    // rises slowly.
    double warmUpSeconds = 0;
    // A measured frame is the mean of so many (FrameOptions::sample), and its time is their sum.
    // Warm-up frames have one sample.
    uint32_t samples = 1;
    // A shard of a sequence draws frame `first` and every `step`-th frame after it. `measured` then
    // counts the frames of the whole sequence, and drawn() those of the shard.
    uint32_t first = 0, step = 1;

    uint32_t drawn() const { return (measured - first + step - 1) / step; }
};

struct MeasuredFrames {
    PassTimes times;
    FrameStats last;
};

// Functions to call before and after each measured frame. Both may be empty.
struct FrameHooks {
    // Changes the options of the measured frame `index`.
    std::function<void(uint32_t index, FrameOptions& options)> prepare;
    // Is called when the GPU has finished the frame and no other is in flight.
    std::function<void(uint32_t index)> finished;
};

// Renders frames through a frame ring with two slots. Warm-up frames and the first measured frame
// show `options`. With `moving`, measured frames are `interval` seconds apart and exposure adapts;
// without it all frames are the same. If exposure converges at once (FrameOptions::resetExposure),
// warm-up frames leave no trace in any image. `onFrame` is called after each sample of a frame is
// submitted, except those of FrameCounts::warmUpSeconds. Returns when the GPU has finished.
MeasuredFrames renderFrames(const VulkanContext& context, Renderer& renderer,
                            const FrameOptions& options, FrameCounts counts, bool moving,
                            const std::function<void()>& onFrame, const FrameHooks& hooks = {},
                            double interval = frameTime);

// Renders one more frame like `options`, but with clustered culling and without a heat map, counts
// its (pixel, light) pairs, and returns its statistics.
CndLightingStats countPairs(const VulkanContext& context, Renderer& renderer, FrameOptions options);

// Returns a table with the spread of the time of each pass, or of one frame its times alone.
std::string passTable(const PassTimes& times);
// Returns a line with the number of lights of each type, if the frame was lit, then a line per
// pass, which says that the pass ran, or why it was skipped, or why it was recorded and timed but
// had nothing to do.
std::string planText(const FrameStats& frame);
// Returns a line with the pairs whose visibility a frame of so many pixels asked for, as
// countPairs() counts them, and with what was missing. Empty if nothing was asked.
std::string shadowText(const CndLightingStats& stats, PixelSize size);

Json toJson(const PassTimes& times);
Json toJson(const std::vector<CndPassPlan>& plan);
// Pairs are 0 if they were not counted. Only frames that asked for visibility have "shadows".
Json toJson(const CndLightingStats& stats);
Json toJson(const CndExposureStats& stats);
Json toJson(const FrameOptions& options, CndGBufferLayout layout);
Json sceneJson(const Scene& scene, const Renderer& renderer);

} // namespace candelabra::app
