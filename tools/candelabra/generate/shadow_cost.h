// SPDX-License-Identifier: Apache-2.0
// Estimates what the shadows of a frame take on a CPU device. It counts, and measures no time, so
// the estimate is the same in every run.
#pragma once

#include <string>

#include "io/parse.h"
#include "scene/scene.h"

namespace candelabra::app
{

// Returns the CPU time of shadows in seconds, summed over all threads, in frames of clustered
// culling. `uncut`: the lights reach everywhere.
double shadowCpuSeconds(const Scene& scene, const Camera& camera, PixelSize size, bool uncut);

// Returns the time in seconds that so much CPU time takes with the cores of this machine.
double secondsOnCores(double cpuSeconds);

// Pictures whose shadows take longer on a CPU device have none unless the user asks for them.
constexpr double mostShadowSeconds = 2;

// Says that a picture has no shadows because they would take this long.
std::string shadowsLeftOutText(double seconds);

} // namespace candelabra::app
