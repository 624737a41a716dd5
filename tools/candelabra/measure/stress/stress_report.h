// SPDX-License-Identifier: Apache-2.0
// What a stress sweep found, for people, programs and eyes.
#pragma once

#include <string>
#include <vector>

#include "measure/stress/stress_point.h"

namespace candelabra::app
{

std::string stressTables(const std::vector<StressPoint>& points);
Json stressJson(const StressSettings& settings, const std::vector<StressPoint>& points);
// GPU time against the number of lights, one line per pass that matters.
std::string stressPlot(const StressSettings& settings, const DeviceInfo& device,
                       const std::vector<StressPoint>& points);

// Sentences about failed checks; empty when all passed.
std::vector<std::string> failedChecks(const std::vector<StressPoint>& points);

} // namespace candelabra::app
