// SPDX-License-Identifier: Apache-2.0
// What a frame saves by leaving out what its content does not need: every skip beside the frame
// that does without it, in interleaved rounds, and the two images.
#pragma once

#include <string>
#include <vector>

#include "io/parse.h"
#include "io/progress.h"
#include "io/report.h"
#include "render/pass_times.h"
#include "render/vulkan_context.h"

namespace candelabra::app
{

struct SkipSettings {
    std::string scene = "hall"; // generated
    PixelSize size{1280, 720};
    uint32_t lights = 4000;
    uint32_t rounds = 7;
    uint32_t pointRounds = 50; // of the row that compares points with points
    uint32_t seed = 1;
};

struct SkipRow {
    std::string name;
    std::string against; // the other frame
    std::string passes;  // whose time it is
    double bar = 0;      // with / without must not exceed it (issue 4); 0: no bar
    // Between the images, relative to the largest value; 0 but where the order of sums may change.
    double bound = 0;
    double difference = 0;
    PassTimes with, without;
    // Where the skip is looked for in vain, and the frame that does not look for it; no frames
    // where looking records nothing.
    PassTimes idleWith, idleWithout;

    double ratio() const; // of medians
};

double skipSteps(const SkipSettings& settings);
std::vector<SkipRow> measureSkips(const VulkanContext& context, const SkipSettings& settings,
                                  Progress& progress);

std::string skipTable(const std::vector<SkipRow>& rows);
Json skipJson(const SkipSettings& settings, const std::vector<SkipRow>& rows);
// Sentences about images that differ by more than the bound; empty: none does.
std::vector<std::string> skipFailures(const std::vector<SkipRow>& rows);

} // namespace candelabra::app
