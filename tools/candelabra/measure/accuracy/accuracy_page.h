// SPDX-License-Identifier: Apache-2.0
// The results of the accuracy benchmark as a page.
#pragma once

#include <string>
#include <vector>

#include "measure/accuracy/image_level.h"
#include "measure/accuracy/kernel_level.h"

namespace candelabra::app
{

// The sections with plots, tables, pictures and maps of their differences.
std::string accuracySections(const KernelLevel& kernels, const std::vector<ImageScene>& scenes,
                             const BudgetSweep& budgets, const DeviceInfo& device);

// The whole page of `candelabra bench accuracy`.
std::string accuracyPage(const Json& provenance, const KernelLevel& kernels,
                         const std::vector<ImageScene>& scenes, const BudgetSweep& budgets,
                         const DeviceInfo& device);

} // namespace candelabra::app
