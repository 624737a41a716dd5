// SPDX-License-Identifier: Apache-2.0
// What `candelabra profile --json` left behind: one run, or several in one file (--append).
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "io/report.h"

namespace candelabra::app
{

constexpr const char* profileSchema = "candelabra profile 1";

// Of a pass or a whole time (wholeTimes) over the frames of a run.
struct ProfiledTime {
    std::string name;
    double minMs = 0, medianMs = 0;
};

struct ProfiledRun {
    std::string where; // "a.json", or "a.json: [2]"
    // What has to be alike for times to be comparable, and what runs of one side share besides;
    // names with values.
    std::vector<std::pair<std::string, std::string>> conditions, version;
    bool still = false;              // every frame draws the same: camera and lights rest
    std::vector<ProfiledTime> times; // of passes, then of wholeTimes
};

// All runs in a file, in order. Throws SceneError for a file that is none of that command, and for
// runs with --ab, whose variants are compared already.
std::vector<ProfiledRun> readRuns(const std::string& path);

// `run` behind those that the file holds; there need not be one. Throws SceneError as above.
Json withRun(const std::string& path, const Json& run);

} // namespace candelabra::app
