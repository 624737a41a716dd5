// SPDX-License-Identifier: Apache-2.0
// The report page of `candelabra bench accuracy`: one HTML file that needs nothing else.
#pragma once

#include <string>
#include <vector>

#include "bench/image_level.h"
#include "bench/kernel_level.h"

namespace candelabra::app
{

std::string accuracyPage(const Json& provenance, const KernelLevel& kernels,
                         const std::vector<ImageScene>& scenes, const BudgetSweep& budgets,
                         const DeviceInfo& device);

} // namespace candelabra::app
