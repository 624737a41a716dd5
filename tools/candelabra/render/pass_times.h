// SPDX-License-Identifier: Apache-2.0
// GPU times of the passes of several frames, and their statistics.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "candelabra/candelabra.h"

namespace candelabra::app
{

// The part of a frame that a pass belongs to: the raster pass is the program's, lighting is that of
// the lighting module, and the rest is exposure, the environment and what changes the image.
enum class FramePart { Raster, Lighting, Rest };

// One pass of one frame.
struct PassTime {
    std::string name; // the kernel's file name
    double ms = 0;
    uint32_t runs = 1; // the pass ran so often; `ms` is the sum, with one timestamp per run
    FramePart part = FramePart::Rest;
};

struct PassSummary {
    std::string name;
    double minMs = 0, medianMs = 0, p95Ms = 0;
};

// Removes ".comp" from the end of a name, so "shade_tiles.comp" becomes "shade_tiles".
std::string passName(const char* kernelName);
std::vector<PassTime> passesOf(std::span<const CndKernelTime> times,
                               FramePart part = FramePart::Rest);

class PassTimes
{
public:
    // Adds the passes of one frame, in order. Times of passes with the same name are added up.
    void add(std::span<const PassTime> frame);
    size_t frames() const { return totals_.size(); }
    // One entry per pass, in the order in which passes first appeared. A pass that a frame did not
    // run counts as 0 ms in that frame. p95 is the nearest rank: the smallest time that 95% of the
    // frames do not exceed.
    std::vector<PassSummary> summary() const;
    // The statistics of each frame's sum over all passes, under the name "total".
    PassSummary total() const;
    // The median of each frame's sum over the passes of a part.
    double medianMs(FramePart part) const;
    // The sums over all passes, one per frame.
    const std::vector<double>& totals() const { return totals_; }

private:
    struct Pass {
        std::string name;
        FramePart part;
        std::vector<double> ms; // one per frame
    };
    std::vector<Pass> passes_;
    std::vector<double> totals_;
};

} // namespace candelabra::app
