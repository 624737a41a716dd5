// SPDX-License-Identifier: Apache-2.0
// Where the numbers of a result come from.
#pragma once

#include <string>

#include "io/report.h"
#include "render/vulkan_instance.h"

namespace candelabra::app
{

// Program version, commit, device, driver, UTC time and command line.
Json provenance(const DeviceInfo& device, const std::string& commandLine);

} // namespace candelabra::app
