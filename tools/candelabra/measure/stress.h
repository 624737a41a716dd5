// SPDX-License-Identifier: Apache-2.0
// Measures a scene with growing numbers of lights: times passes, counts lists and pairs, compares
// with brute force and between two runs, and saves pictures.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "io/progress.h"
#include "measure/frame/brute_check.h"
#include "measure/frame/frames.h"
#include "measure/frame_rate.h"
#include "scene/scene_options.h"

namespace candelabra::app
{

struct StressSettings {
    std::string scene; // named as for loadScene
    SceneOptions sceneOptions;
    std::string camera; // `wanted` of selectCamera
    PixelSize size;
    CndGBufferLayout gbufferLayout = CND_GBUFFER_FULL;
    FrameOptions frame; // its camera and lightsVisible are set from the scene
    std::optional<bool> lightsVisible;
    FrameCounts counts;
    CheckExtent check = CheckExtent::Auto;
    std::string directory; // where pictures are written
    // Set if the number of lights is searched that takes this time. Then there are no pictures, and
    // only frames that take about so long are measured as often as `counts` says.
    std::optional<double> frameMs;
};

struct StressPoint {
    uint32_t lights = 0; // of the scene
    uint32_t asked = 0;  // the number that was asked for; files have more lights
    PixelSize size;
    PassTimes times;
    CndLightingStats stats{}; // including counted pairs
    CndExposureStats exposure{};
    BruteCheck check;
    // True if a second, new renderer gave the same image, bit for bit; none with CheckExtent::None.
    std::optional<bool> identical;
    std::string image; // the path of the picture; empty if there is none
    Json scene;

    FrameCost cost() const;
};

// Estimates how long measuring a point takes, in seconds on two CPU cores.
double estimatedSeconds(const StressSettings& settings, uint32_t lights);

StressPoint measureStressPoint(const VulkanContext& context, const StressSettings& settings,
                               uint32_t lights, Progress& progress);

std::string stressTables(const std::vector<StressPoint>& points);
// The parts of the frame for the numbers of lights that were tried in a search.
std::string searchTable(const std::vector<StressPoint>& points);
Json stressJson(const StressSettings& settings, const std::vector<StressPoint>& points);
// Plots GPU time against the number of lights, with a line for each pass that takes a visible
// share, and one at StressSettings::frameMs, or at 60 frames/s if the total time crosses it.
std::string stressPlot(const StressSettings& settings, const DeviceInfo& device,
                       const std::vector<StressPoint>& points);

// Returns a sentence about each check that failed.
std::vector<std::string> failedChecks(const std::vector<StressPoint>& points);

} // namespace candelabra::app
