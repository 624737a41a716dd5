// SPDX-License-Identifier: Apache-2.0
// What every command says on stderr about its scene and its device.
#pragma once

#include <cstddef>

#include "render/vulkan_context.h"
#include "scene/scene.h"

namespace candelabra::app
{

// Logs what a loader understood but did not use.
void logWarnings(const Scene& scene);

// Prints the validation messages collected so far on stderr and returns how many there were.
size_t printValidationMessages(const VulkanContext& context);

} // namespace candelabra::app
