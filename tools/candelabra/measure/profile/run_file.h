// SPDX-License-Identifier: Apache-2.0
// Reads files that `candelabra profile --json` has written. A file holds one run, or several if it
// was written with --append.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "io/report.h"

namespace candelabra::app
{

constexpr const char* profileSchema = "candelabra profile 1";

// The time of a pass, or one of wholeTimes, over the frames of a run.
struct ProfiledTime {
    std::string name;
    double minMs = 0, medianMs = 0;
};

struct ProfiledRun {
    std::string where; // "a.json", or "a.json: [2]"
    // Names with values. Runs are comparable if their conditions are equal; runs of the same side
    // of a comparison also have the same version.
    std::vector<std::pair<std::string, std::string>> conditions, version;
    bool still = false;              // all frames are the same: camera and lights do not move
    std::vector<ProfiledTime> times; // the passes, then wholeTimes
};

// Returns all runs in a file, in order. Throws SceneError if the file was not written by
// `candelabra profile`, and for a run with --ab or --what-if, which compares its variants itself.
std::vector<ProfiledRun> readRuns(const std::string& path);

// Returns the runs that the file holds, if it exists, followed by `run`. Throws SceneError like
// readRuns.
Json withRun(const std::string& path, const Json& run);

} // namespace candelabra::app
