// SPDX-License-Identifier: Apache-2.0
// Frames of a scene, one after another, and the time of each of their passes.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "io/report.h"
#include "measure/profile/gpu_clock.h"
#include "measure/profile/profile_trace.h"
#include "render/renderer.h"

namespace candelabra::app
{

// Times of one kind of frame, a value per frame in every series. Those of the GPU are without what
// its timestamps themselves take.
struct FrameSeries {
    struct Pass {
        std::string name;
        std::vector<double> ms;
    };
    std::vector<Pass> passes;   // on the GPU, in order of first appearance; 0 where it did not run
    std::vector<double> gpuMs;  // sum of the passes
    std::vector<double> spanMs; // GPU: from the first stamp of the frame to the last
    std::vector<double> uploadMs; // CPU: moving lights; 0 where nothing moves
    std::vector<double> recordMs; // CPU: recording commands
    std::vector<double> frameMs;  // from the start of upload until the GPU is done
    std::vector<double> stamps;   // taken by the frame

    void add(const FrameStats& frame, const CpuSpans& cpu, double stampMs);
    double shadingMs() const; // median of the passes that evaluate lights
};

// Of a frame beside its passes: rows behind theirs.
struct WholeTime {
    const char* name; // for people
    const char* key;  // in results
    const std::vector<double> FrameSeries::*ms;
};
constexpr WholeTime wholeTimes[] = {
    {"GPU, sum of passes", "gpu", &FrameSeries::gpuMs},
    {"GPU, first stamp to last", "gpuSpan", &FrameSeries::spanMs},
    {"CPU, moving lights", "upload", &FrameSeries::uploadMs},
    {"CPU, recording", "record", &FrameSeries::recordMs},
    {"frame, until the GPU is done", "frame", &FrameSeries::frameMs}};

// What timing costs a frame.
struct ProfilingOverhead {
    double stamps = 0; // median of a frame
    double share = 0;  // what they take, of the GPU's time from first to last
    double passes = 0; // what the passes add up to, of the same; median of the frames
};

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
    double stampMs = 0;           // what a timestamp takes on the GPU
};

ProfilingOverhead overheadOf(const FrameSeries& series, double stampMs);

// The camera of round `i` of `rounds`; Turn: once around the vertical through its position.
Camera cameraAt(const Camera& camera, CameraPath path, uint32_t i, uint32_t rounds);

// One frame at a time, so that none waits for another. `onRound` is called after each round, those
// of warming up included; measured frames go into `trace` where there is one.
Profile profileFrames(const VulkanContext& context, Renderer& renderer,
                      const ProfileSettings& settings, ProfileTrace* trace,
                      const std::function<void()>& onRound);

// Tables for people: of each pass; of two variants, what of the second's time differs.
std::string seriesTable(const FrameSeries& series);
std::string overheadText(const FrameSeries& series, double stampMs);
std::string comparisonTable(const FrameSeries& a, const FrameSeries& b);

Json toJson(const FrameSeries& series);
Json overheadJson(const FrameSeries& series, double stampMs);
Json comparisonJson(const FrameSeries& a, const FrameSeries& b);
// A line per frame: variant, frame, then every series, milliseconds.
std::string toCsv(const std::vector<std::string>& names, const std::vector<FrameSeries>& series);

} // namespace candelabra::app
