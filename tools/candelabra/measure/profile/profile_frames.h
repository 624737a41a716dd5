// SPDX-License-Identifier: Apache-2.0
// Draws frames of a scene one after another and measures the time of each of their passes.
#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <vector>

#include "io/report.h"
#include "io/table.h"
#include "render/camera_path.h"
#include "render/renderer.h"

namespace candelabra::app
{

using CpuClock = std::chrono::steady_clock;

// When the CPU started a frame and when it finished each step, in order.
struct CpuSpans {
    CpuClock::time_point start{}, uploaded{}, recorded{}, done{};
};

// The times of one variant of the frame, with a value per frame in every series. The time that the
// timestamps themselves take on the GPU is subtracted from the times of the GPU (passes, gpuMs,
// spanMs), but not from frameMs.
struct FrameSeries {
    struct Pass {
        std::string name;
        std::vector<double> ms;
    };
    // GPU passes in the order in which they first appeared. A pass has 0 ms in frames that did not
    // run it.
    std::vector<Pass> passes;
    std::vector<double> gpuMs;    // GPU: the sum of the passes
    std::vector<double> spanMs;   // GPU: from the first timestamp of the frame to the last
    std::vector<double> uploadMs; // CPU: moving lights; 0 if nothing moves
    std::vector<double> recordMs; // CPU: recording commands
    // From the start of the upload, or from the end of the previous frame if that was later, until
    // the GPU has finished.
    std::vector<double> frameMs;
    std::vector<double> stamps; // the number of timestamps in the frame

    // `previousDone` is the end of the previous frame.
    void add(const FrameStats& frame, const CpuSpans& cpu, CpuClock::time_point previousDone,
             double stampMs);
    // Returns, for each frame, the time in ms of the passes that evaluate the lights of clusters:
    // shade_tiles and shade_unlisted.
    std::vector<double> shadingMs() const;
};

// The times of a whole frame. In tables their rows follow the rows of the passes.
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

// The cost of the timing itself in a frame.
struct ProfilingOverhead {
    double stamps = 0; // timestamps in a frame, median
    double share = 0;  // the time of these timestamps divided by the median of spanMs
    double passes = 0; // gpuMs divided by spanMs, median of the frames
};

struct ProfileSettings {
    // The variants are drawn in turn, and in the opposite order in every other round.
    std::vector<FrameOptions> variants;
    // If it is not null, this renderer draws all variants but the first. It must have as many frame
    // slots as the first.
    Renderer* other = nullptr;
    CameraPath path = CameraPath::Still;
    bool moving = false; // lights move; a round is a sixtieth of a second
    uint32_t rounds = 1;
    double warmUpSeconds = 0; // the warm-up takes at least so long
    // The CPU records so many frames before it waits for the oldest of them, so that with more than
    // one the GPU is never idle. The renderer must have as many slots.
    uint32_t framesInFlight = 1;
};

// Warm-up rounds are drawn until the median of the last warmUpWindow frame times differs from the
// median of the warmUpWindow before them by at most the share `stable`; maxWarmUp rounds at most,
// or more if ProfileSettings::warmUpSeconds have not passed.
constexpr uint32_t warmUpWindow = 3, maxWarmUp = 24;
constexpr double stable = 0.05;
constexpr uint32_t maxFramesInFlight = 3;

struct Profile {
    std::vector<FrameSeries> series; // one per variant
    uint32_t warmUpRounds = 0;
    bool settled = false;                 // the warm-up ended because times were stable
    std::vector<FrameStats> last;         // one per variant
    std::vector<uint64_t> drawnTriangles; // by the first camera, one per variant
    double stampMs = 0;                   // the time that a timestamp takes on the GPU
};

ProfilingOverhead overheadOf(const FrameSeries& series, double stampMs);

// Draws all rounds. `onRound` is called after each round, except for warm-up rounds beyond
// maxWarmUp.
Profile profileFrames(const VulkanContext& context, Renderer& renderer,
                      const ProfileSettings& settings, const std::function<void()>& onRound);

// Text for people: the times of each pass; what the timestamps cost; and for two variants the ratio
// of the second's times to the first's.
Table seriesTable(const FrameSeries& series);
std::string overheadText(const FrameSeries& series, double stampMs);
std::string comparisonTable(const FrameSeries& a, const FrameSeries& b);

Json toJson(const FrameSeries& series);
Json overheadJson(const FrameSeries& series, double stampMs);
// The ratio of paired times, as in each row of comparisonJson.
Json ratioJson(const std::vector<double>& a, const std::vector<double>& b);
Json comparisonJson(const FrameSeries& a, const FrameSeries& b);
// One line per frame: the variant, the frame, and the value of every series in milliseconds.
std::string toCsv(const std::vector<std::string>& names, const std::vector<FrameSeries>& series);

} // namespace candelabra::app
