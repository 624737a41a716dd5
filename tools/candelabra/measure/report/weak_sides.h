// SPDX-License-Identifier: Apache-2.0
// The sentence of the report about what Candelabra is bad at: what it costs, where its errors are
// largest, and which efforts gain nothing. Only what the run shows to be weak is named.
#pragma once

#include <string>
#include <vector>

#include "measure/accuracy/image_level.h"
#include "measure/accuracy/kernel_level.h"
#include "measure/culling/culling.h"

namespace candelabra::app
{

// The results of the parts of the report. Parts that were not measured are empty.
struct WeakSideFacts {
    KernelLevel kernels;
    std::vector<ImageScene> scenes;
    std::vector<CullingPoint> culling;
};

std::string weaknessSentence(const WeakSideFacts& facts);

} // namespace candelabra::app
