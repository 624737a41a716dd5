// SPDX-License-Identifier: Apache-2.0
// Measures on whole frames the GPU time of lighting against the image's error. Time and error come
// from the same frames. The methods are drawn in turn.
#pragma once

#include <string>
#include <vector>

#include "io/progress.h"
#include "io/table.h"
#include "measure/accuracy/image_error.h"
#include "measure/kernels/light_kernels.h"
#include "render/renderer.h"

namespace candelabra::app
{

// The methods that frames can be lit with, beginning with the representative point (karis).
std::vector<MeasuredMethod> imageMethods();

struct ImageLevelSettings {
    std::vector<MeasuredMethod> methods = imageMethods(); // times are relative to the first
    std::vector<std::string> scenes; // names of the scenes; none: all that benchScenes() returns
    PixelSize size{192, 144};
    uint32_t rounds = 5; // frames of every variant, after one warm-up frame
    double truthTolerance = 1e-4;
    uint32_t sampleCount = 16; // samples per light of the sampled method
};

// GPU times, medians over the rounds. A competing method has no lists, so its only time is
// bruteForceMs.
struct FrameTime {
    double lightingMs = 0; // all passes of the lighting module
    double shadingMs = 0;  // the passes that evaluate lights
    double ratio = 0;      // of lightingMs to the first variant's
    // The passes that evaluate every light at every pixel, of another frame.
    double bruteForceMs = 0;
    bool noisy = false; // the rounds' times of bruteForceMs are
};

struct ImagePoint {
    MeasuredMethod method;
    FrameTime time;
    ImageDifference error;
    Image radiance;
};

struct ImageScene {
    std::string name, about;
    Image truth;
    uint64_t unconverged = 0;
    std::vector<ImagePoint> points; // the first is karis
};

// The benchmark's own scenes of planes and balls, which together hold area lights of every type,
// and the showcase.
std::vector<Scene> benchScenes();

double imageLevelSteps(const ImageLevelSettings& settings);
std::vector<ImageScene> measureImages(const VulkanContext& context,
                                      const ImageLevelSettings& settings, Progress& progress);

std::vector<Table> imageTables(const std::vector<ImageScene>& scenes);
Json imageJson(const ImageLevelSettings& settings, const std::vector<ImageScene>& scenes);
// Plots relMSE against milliseconds by brute force, one series per method.
std::string imagePlot(const std::vector<ImageScene>& scenes, const DeviceInfo& device);

} // namespace candelabra::app
