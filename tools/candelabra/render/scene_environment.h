// SPDX-License-Identifier: Apache-2.0
// Uploads the environment of a scene to the device.
#pragma once

#include "candelabra/candelabra.hpp"
#include "render/vulkan_context.h"
#include "scene/scene.h"

namespace candelabra::app
{

struct EnvironmentOptions {
    CndGBufferLayout gbufferLayout = CND_GBUFFER_FULL;
    uint32_t framesInFlight = 1;
};

// Returns the environment, ready for frames. Throws UsageError, RunError or gpu::Failure.
Environment uploadEnvironment(const VulkanContext& context, const SceneEnvironment& environment,
                              const EnvironmentOptions& options);

// Sets CndEnvironmentFrame::worldFromEnvironment to a rotation about the y axis by `rotation`
// radians, counter-clockwise seen from above.
void setEnvironmentRotation(double rotation, float (&worldFromEnvironment)[9]);

} // namespace candelabra::app
