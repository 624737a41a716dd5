// SPDX-License-Identifier: Apache-2.0
// GPU times of the passes of several frames, and what is worth saying about them.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "candelabra/candelabra.h"

namespace candelabra::app
{

// One pass of one frame.
struct PassTime {
    std::string name; // the kernel's file name
    double ms = 0;
    double startMs = 0; // since the frame's start, with RendererOptions::stamps
    uint32_t runs = 1;  // that the time is the sum of, with a stamp each
};

struct PassSummary {
    std::string name;
    double minMs = 0, medianMs = 0, p95Ms = 0;
};

// "shade_tiles.comp" -> "shade_tiles"; other names stay.
std::string passName(const char* kernelName);

class PassTimes
{
public:
    // One frame's passes in order; a name that occurs twice is added up.
    void add(std::span<const PassTime> frame);
    size_t frames() const { return totals_.size(); }
    // In order of first appearance; passes missing from a frame count as 0 there. p95 is the
    // nearest rank: the smallest time that 95% of the frames do not exceed.
    std::vector<PassSummary> summary() const;
    // Sum of all passes, per frame; name "total".
    PassSummary total() const;

private:
    struct Pass {
        std::string name;
        std::vector<double> ms; // one per frame
    };
    std::vector<Pass> passes_;
    std::vector<double> totals_;
};

} // namespace candelabra::app
