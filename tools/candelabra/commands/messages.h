// SPDX-License-Identifier: Apache-2.0
// Messages on stderr about the scene and the device, which most commands print.
#pragma once

#include <cstddef>

#include "render/vulkan_context.h"
#include "scene/scene.h"

namespace candelabra::app
{

// Logs the warnings of the scene's loader, at most ten of them.
void logWarnings(const Scene& scene);

// Prints the validation messages collected so far on stderr and returns how many there were.
size_t printValidationMessages(const VulkanContext& context);

} // namespace candelabra::app
