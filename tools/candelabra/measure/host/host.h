// SPDX-License-Identifier: Apache-2.0
// Measures what lights cost on the CPU: moving, setting and updating them, and recording the frame
// that uploads them. Every call stands beside a memcpy of the bytes that it cannot avoid to move.
#pragma once

#include <string>
#include <vector>

#include "io/progress.h"
#include "io/report.h"
#include "render/vulkan_context.h"

namespace candelabra::app
{

struct HostSettings {
    std::vector<uint32_t> lights{1000, 10'000, 100'000, 1'000'000};
    uint32_t rounds = 9; // each makes every call once, after one round that is not measured
    uint32_t seed = 1;
};

// One call for some lights of a set, in the order of the rounds.
struct HostCall {
    std::string name;
    uint32_t written = 0;            // lights that the call is for
    std::vector<double> ms, cpuMs;   // of the call; CPU time is that of all threads
    std::vector<double> memcpyMs;    // of as many bytes as the call must read and write
    std::vector<double> recordingMs; // of the frame after the call; empty: nothing was recorded
};

struct HostPoint {
    uint32_t lights = 0;
    std::vector<HostCall> calls;
};

std::vector<HostPoint> measureHost(const VulkanContext& context, const HostSettings& settings,
                                   Progress& progress);
std::string hostTable(const std::vector<HostPoint>& points);
Json hostJson(const HostSettings& settings, const std::vector<HostPoint>& points);

} // namespace candelabra::app
