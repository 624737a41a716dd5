// SPDX-License-Identifier: Apache-2.0
// ProfileTrace collects what CPU and GPU did for every frame on one time axis, and writes it in
// Chrome's trace event format, which Perfetto reads.
#pragma once

#include <string>
#include <vector>

#include "io/report.h"
#include "measure/profile/gpu_clock.h"
#include "render/renderer.h"

namespace candelabra::app
{

// The times at which the CPU started a frame and finished each step, in order.
struct CpuSpans {
    CpuClock::time_point start{}, uploaded{}, recorded{}, submitted{}, done{};
};

// With more frames viewers of the trace become slow: a frame has about 25 slices.
constexpr uint32_t maxTracedFrames = 10'000;

class ProfileTrace
{
public:
    // `variants` are the names of the variants.
    explicit ProfileTrace(std::vector<std::string> variants) : variants_(std::move(variants)) {}

    // Adds a frame, which must have been drawn with RendererOptions::stamps, and `clock` calibrated
    // shortly after it. A pass that ran several times is one slice, placed at its first run.
    void add(size_t variant, const CpuSpans& cpu, const FrameStats& frame, const GpuClock& clock);
    std::string text(const Json& provenance) const;

private:
    double microseconds(CpuClock::time_point t) const;
    void slice(const char* category, uint32_t thread, const std::string& name, double from,
               double to, const Json& arguments);

    std::vector<std::string> variants_;
    CpuClock::time_point begin_{};
    uint32_t frames_ = 0;
    double uncertaintyMs_ = 0; // the largest of all frames
    std::string alignedBy_;
    Json events_ = Json::array();
};

} // namespace candelabra::app
