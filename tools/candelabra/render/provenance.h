// SPDX-License-Identifier: Apache-2.0
// The provenance of the numbers in a result.
#pragma once

#include <string>

#include "io/report.h"
#include "render/vulkan_instance.h"

namespace candelabra::app
{

// Returns the program's version and commit, the device, its driver, the time (UTC) and the command
// line.
Json provenance(const DeviceInfo& device, const std::string& commandLine);
// The same for results that no device was used for: with the processor's architecture and number of
// hardware threads in place of device and driver.
Json provenance(const std::string& commandLine);

} // namespace candelabra::app
