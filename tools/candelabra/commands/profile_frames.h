// SPDX-License-Identifier: Apache-2.0
// Frames of a scene, one after another, and the time of each of their passes.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "io/report.h"
#include "render/renderer.h"

namespace candelabra::app
{

// Times of one kind of frame, a value per frame in every series.
struct FrameSeries {
    struct Pass {
        std::string name;
        std::vector<double> ms;
    };
    std::vector<Pass> passes;  // on the GPU, in order of first appearance; 0 where it did not run
    std::vector<double> gpuMs; // sum of the passes
    std::vector<double> recordMs; // CPU: recording commands, lights of a moving scene included
    std::vector<double> frameMs;  // from the start of recording until the GPU is done

    void add(const FrameStats& frame, double record, double whole);
};

// Of a frame beside its passes: rows behind theirs.
struct WholeTime {
    const char* name; // for people
    const char* key;  // in results
    const std::vector<double> FrameSeries::*ms;
};
constexpr WholeTime wholeTimes[] = {
    {"GPU, sum of passes", "gpu", &FrameSeries::gpuMs},
    {"CPU, recording", "record", &FrameSeries::recordMs},
    {"frame, until the GPU is done", "frame", &FrameSeries::frameMs}};

enum class CameraPath { Still, Turn };

struct ProfileSettings {
    std::vector<FrameOptions> variants; // drawn in turn, each round in the other order
    CameraPath path = CameraPath::Still;
    bool moving = false; // lights: a sixtieth of a second from frame to frame
    uint32_t rounds = 1;
};

// What is drawn before measuring: until the median of the last `warmUpWindow` rounds is within
// `stable` of that of those before, maxWarmUp rounds at most.
constexpr uint32_t warmUpWindow = 3, maxWarmUp = 24;
constexpr double stable = 0.05;

struct Profile {
    std::vector<FrameSeries> series; // one per variant
    uint32_t warmUpRounds = 0;
    bool settled = false;         // warming up ended because times were stable
    std::vector<FrameStats> last; // one per variant
};

// The camera of round `i` of `rounds`; Turn: once around the vertical through its position.
Camera cameraAt(const Camera& camera, CameraPath path, uint32_t i, uint32_t rounds);

// One frame at a time, so that none waits for another. `onRound` is called after each round, those
// of warming up included.
Profile profileFrames(const VulkanContext& context, Renderer& renderer,
                      const ProfileSettings& settings, const std::function<void()>& onRound);

// Tables for people: of each pass; of two variants, what of the second's time differs.
std::string seriesTable(const FrameSeries& series);
std::string comparisonTable(const FrameSeries& a, const FrameSeries& b);

Json toJson(const FrameSeries& series);
Json comparisonJson(const FrameSeries& a, const FrameSeries& b);
// A line per frame: variant, frame, then every series, milliseconds.
std::string toCsv(const std::vector<std::string>& names, const std::vector<FrameSeries>& series);

} // namespace candelabra::app
