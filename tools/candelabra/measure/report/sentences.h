// SPDX-License-Identifier: Apache-2.0
// The five sentences at the top of the report. They are made from the results of the run, so that
// their words change with the numbers. A part that was not measured is named as missing.
#pragma once

#include <string>
#include <vector>

#include "measure/accuracy/image_level.h"
#include "measure/accuracy/kernel_level.h"
#include "measure/culling/culling.h"
#include "measure/stability/stability.h"

namespace candelabra::app
{

// The program, and the device that it ran on.
struct RunFacts {
    DeviceInfo device;
    std::string version, commit;
    size_t parts = 0;
    double wallSeconds = 0, processorSeconds = 0;
};

std::string runSentence(const RunFacts& facts);
std::string speedSentence(const std::vector<CullingPoint>& points);
std::string accuracySentence(const KernelLevel& level, const std::vector<ImageScene>& scenes);
std::string stabilitySentence(const Stability& stability);

// The largest share of invalid responses that 95% confidence allows if `invalid` of `tried`
// random inputs gave one (Poisson).
double largestShare(uint64_t invalid, uint64_t tried);

} // namespace candelabra::app
