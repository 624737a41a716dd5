// SPDX-License-Identifier: Apache-2.0
// Messages on stderr about the scene and the device, which most commands print.
#pragma once

#include <cstddef>
#include <string>

#include "render/vulkan_context.h"
#include "scene/scene.h"

namespace candelabra::app
{

// Logs the warnings of the scene's loader, at most ten of them, and its notes.
void logWarnings(const Scene& scene);
// Logs warnings about the shadows of a scene that is drawn with shadows.
void warnOfShadows(const Scene& scene);

// Says with which exposure a frame was drawn, and what helps if automatic exposure has reached an
// end of its range. `given` tells whether --exposure has set the EV100.
std::string exposureText(const CndExposureSettings& settings, const Scene& scene, bool given,
                         const CndExposureStats& stats);

// Prints the validation messages collected so far on stderr and returns how many there were.
size_t printValidationMessages(const VulkanContext& context);

} // namespace candelabra::app
