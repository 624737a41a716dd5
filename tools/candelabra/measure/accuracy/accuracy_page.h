// SPDX-License-Identifier: Apache-2.0
// What the page of `candelabra report` shows of the accuracy benchmark.
#pragma once

#include <string>
#include <vector>

#include "measure/accuracy/image_level.h"
#include "measure/accuracy/kernel_level.h"

namespace candelabra::app
{

// Every scene's pictures, as a slider between the truth and another method.
std::string accuracyPictures(const std::vector<ImageScene>& scenes);
std::string accuracyPlots(const KernelLevel& kernels, const std::vector<ImageScene>& scenes,
                          const DeviceInfo& device);
std::vector<Table> accuracyTables(const KernelLevel& kernels,
                                  const std::vector<ImageScene>& scenes);
// The worst samples and pixels, in long tables.
std::vector<Table> accuracyDetails(const KernelLevel& kernels,
                                   const std::vector<ImageScene>& scenes);

} // namespace candelabra::app
