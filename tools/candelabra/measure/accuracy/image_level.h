// SPDX-License-Identifier: Apache-2.0
// Whole frames: GPU time of lighting against the image's error to its truth, and what an error
// budget saves and costs. Time and error come from the same frames, methods interleaved.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "io/progress.h"
#include "measure/accuracy/image_error.h"
#include "render/renderer.h"
#include "scene/scene_error.h"

namespace candelabra::app
{

// The methods that frames can be lit by, the representative point first.
std::vector<CndSpecularMethod> imageMethods();

struct ImageLevelSettings {
    std::vector<CndSpecularMethod> methods = imageMethods(); // times are relative to the first
    PixelSize size{192, 144};
    uint32_t rounds = 5; // frames of every variant, after one to warm up
    double truthTolerance = 1e-4;
    uint32_t sampleCount = 16; // of the sampled method
    // The scene of the error-budget sweep, as for loadScene, and its image.
    std::string budgetScene = "hall";
    std::optional<uint32_t> budgetLights;
    PixelSize budgetSize{640, 360};
};

struct FrameTime {
    double lightingMs = 0; // median over the rounds: all passes of the lighting module
    double shadingMs = 0;  // of those, the ones that evaluate lights
    double ratio = 0;      // of lighting to the first variant, median over the rounds
};

struct ImagePoint {
    CndSpecularMethod method;
    FrameTime time;
    ImageDifference error;
    Image radiance;
};

struct ImageScene {
    std::string name, about;
    Image truth;
    uint64_t unconverged = 0;
    std::vector<ImagePoint> points; // karis first
};

struct BudgetPoint {
    CndSpecularMethod method;
    double budget;
    FrameTime time;         // ratio: to the full evaluation with karis
    double ratioToFull = 0; // to the same method without a budget
    // To the same method without a budget, all channels:
    double meanRel = 0, p99Rel = 0; // where the full image is lit
    double maxOverPeak = 0;
};

struct BudgetSweep {
    std::string scene;
    size_t lights = 0;
    PixelSize size;
    std::vector<BudgetPoint> points; // karis first, then conic with growing budgets
};

// Planes and balls under lights of every kind.
std::vector<Scene> benchScenes();

double imageLevelSteps(const ImageLevelSettings& settings);
std::vector<ImageScene> measureImages(const VulkanContext& context,
                                      const ImageLevelSettings& settings, Progress& progress);
// The scene of the error-budget sweep, made. Throws SceneError, so before the long part.
Scene budgetScene(const ImageLevelSettings& settings);
BudgetSweep measureBudgets(const VulkanContext& context, const ImageLevelSettings& settings,
                           const Scene& scene, Progress& progress);

std::string imageTables(const std::vector<ImageScene>& scenes, const BudgetSweep& budgets);
Json imageJson(const ImageLevelSettings& settings, const std::vector<ImageScene>& scenes,
               const BudgetSweep& budgets);
// relMSE against milliseconds, one series per method.
std::string imagePlot(const std::vector<ImageScene>& scenes, const DeviceInfo& device);

} // namespace candelabra::app
