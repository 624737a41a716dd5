// SPDX-License-Identifier: Apache-2.0
// One light count of a stress sweep: timed, counted, compared and pictured.
#pragma once

#include <string>

#include "io/progress.h"
#include "measure/frame/brute_check.h"
#include "measure/frame/frames.h"
#include "scene/scene_options.h"

namespace candelabra::app
{

struct StressSettings {
    std::string scene; // as for loadScene
    SceneOptions sceneOptions;
    std::string camera; // as for selectCamera
    PixelSize size;
    CndGBufferLayout gbufferLayout = CND_GBUFFER_FULL;
    FrameOptions frame; // camera and lightsVisible come from the scene
    std::optional<bool> lightsVisible;
    FrameCounts counts;
    CheckExtent check = CheckExtent::Auto;
    std::string directory; // for images
};

struct StressPoint {
    uint32_t lights = 0;
    PassTimes times;
    CndLightingStats stats{}; // with pairs counted
    CndExposureStats exposure{};
    BruteCheck check;
    bool identical = false; // a second renderer, made from nothing, gave the same bits
    std::string image;      // path of the picture
    Json scene;
};

// What measuring a point costs, in seconds of two CPU cores; for the progress bar only.
double estimatedSeconds(const StressSettings& settings, uint32_t lights);

StressPoint measureStressPoint(const VulkanContext& context, const StressSettings& settings,
                               uint32_t lights, Progress& progress);

} // namespace candelabra::app
