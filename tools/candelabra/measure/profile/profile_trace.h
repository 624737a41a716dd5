// SPDX-License-Identifier: Apache-2.0
// ProfileTrace: what CPU and GPU did for every frame, in one time, as a file of Chrome's trace
// event format, which Perfetto reads.
#pragma once

#include <string>
#include <vector>

#include "io/report.h"
#include "measure/profile/gpu_clock.h"
#include "render/renderer.h"

namespace candelabra::app
{

// When the CPU was done with what, one after another.
struct CpuSpans {
    CpuClock::time_point start{}, uploaded{}, recorded{}, submitted{}, done{};
};

// Beyond it viewers become slow: about 25 slices a frame.
constexpr uint32_t maxTracedFrames = 10'000;

class ProfileTrace
{
public:
    // Names of the variants.
    explicit ProfileTrace(std::vector<std::string> variants) : variants_(std::move(variants)) {}

    // `clock` was calibrated beside the frame, which was drawn with RendererOptions::stamps. Passes
    // that ran several times are one slice, at the place of the first.
    void add(size_t variant, const CpuSpans& cpu, const FrameStats& frame, const GpuClock& clock);
    std::string text(const Json& provenance) const;

private:
    double microseconds(CpuClock::time_point t) const;
    void slice(const char* category, uint32_t thread, const std::string& name, double from,
               double to, const Json& arguments);

    std::vector<std::string> variants_;
    CpuClock::time_point begin_{};
    uint32_t frames_ = 0;
    double uncertaintyMs_ = 0; // largest
    std::string alignedBy_;
    Json events_ = Json::array();
};

} // namespace candelabra::app
