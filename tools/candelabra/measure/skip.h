// SPDX-License-Identifier: Apache-2.0
// Measures what a frame saves by leaving out what its content does not need. For every such skip, a
// frame with it and a frame without it are drawn in interleaved rounds, and their images are
// compared.
#pragma once

#include <string>
#include <vector>

#include "io/parse.h"
#include "io/progress.h"
#include "io/report.h"
#include "io/statistics.h"
#include "io/table.h"
#include "render/pass_times.h"
#include "render/vulkan_context.h"

namespace candelabra::app
{

struct SkipSettings {
    std::string scene = "hall"; // a generated scene
    PixelSize size{1280, 720};
    uint32_t lights = 4000;
    uint32_t rounds = 7;
    uint32_t pointRounds = 50; // rounds of the row that compares point lights with point lights
    uint32_t seed = 1;
};

struct SkipRow {
    std::string name;
    std::string against; // what the frame without the skip is
    std::string passes;  // which passes the times are of
    double bar = 0; // the greatest ratio of the times with and without the skip; 0: none is set
    // The difference of the images relative to the largest value, and its bound, which is 0 unless
    // the order of sums may change or lights that are too dim to see are left out.
    double bound = 0;
    double difference = 0;
    PassTimes with, without;
    // Frames that look for the skip and do not find it, and the same frames without looking. They
    // hold no frame if looking records nothing.
    PassTimes idleWith, idleWithout;

    double ratio() const; // of the median times with and without the skip
    // The ratio of the times with and without the skip in the same round, and its interval.
    PairedRatio interval() const;
    // Whether the whole interval is above the bar. Without an interval, that is not known.
    bool isOverBar() const;
    // What looking for the skip adds to a frame that does not have it, as a share; 0 if nothing.
    double shareInVain() const;
    std::string key() const; // names the row, to compare it with earlier results
};

std::string skipKey(const std::string& name, const std::string& against);
double skipSteps(const SkipSettings& settings);
std::vector<SkipRow> measureSkips(const VulkanContext& context, const SkipSettings& settings,
                                  Progress& progress);

Table skipTable(const std::vector<SkipRow>& rows);
Json skipJson(const SkipSettings& settings, const std::vector<SkipRow>& rows);
// Returns a sentence about each row whose images differ by more than the bound.
std::vector<std::string> skipFailures(const std::vector<SkipRow>& rows);

} // namespace candelabra::app
