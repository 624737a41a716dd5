// SPDX-License-Identifier: Apache-2.0
// The environment of a scene, on the device.
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

// The environment as a light, ready for frames: uploads the image and waits until the device has
// made of it what shading needs. Throws UsageError, RunError or gpu::Failure.
Environment uploadEnvironment(const VulkanContext& context, const SceneEnvironment& environment,
                              const EnvironmentOptions& options);

// worldFromEnvironment of CndEnvironmentFrame: the image turned about the y axis, counter-clockwise
// seen from above, by `rotation` radians.
void setEnvironmentRotation(double rotation, float (&worldFromEnvironment)[9]);

} // namespace candelabra::app
