// SPDX-License-Identifier: Apache-2.0
// Uploads the environment of a scene to the device.
#pragma once

#include "candelabra/candelabra.hpp"
#include "io/cache_folder.h"
#include "render/vulkan_context.h"
#include "scene/scene.h"

namespace candelabra::app
{

struct EnvironmentOptions {
    CndGBufferLayout gbufferLayout = CND_GBUFFER_FULL;
    uint32_t framesInFlight = 1;
    CacheFolder cache; // of prepared environments (decision 65)
};

// Returns the environment, ready for frames: as the cache has it, or else prepared by the device
// from the image and then stored in the cache. Both give the same bits. Throws UsageError, RunError
// or gpu::Failure.
Environment uploadEnvironment(const VulkanContext& context, const SceneEnvironment& environment,
                              const EnvironmentOptions& options);

// Sets CndEnvironmentFrame::worldFromEnvironment to a rotation about the y axis by `rotation`
// radians, counter-clockwise seen from above.
void setEnvironmentRotation(double rotation, float (&worldFromEnvironment)[9]);

} // namespace candelabra::app
