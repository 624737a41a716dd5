// SPDX-License-Identifier: Apache-2.0
// How many lights a device can take, and from which kind of buffer its kernels read them.
#pragma once

#include "gpu/device.h"

namespace candelabra::lighting
{

// Returns the number of lights in the largest set that a device with these limits can take.
uint32_t maxLights(const VkPhysicalDeviceLimits& limits);

// Returns the value of SPEC_LIGHTS_AS_TEXELS. It is 1 if the device's texel buffers can hold
// maxLights() lights: then kernels read lights from a texel buffer. Otherwise it is 0, and kernels
// read lights from a storage buffer.
uint32_t lightsAsTexels(const gpu::Device& device);

} // namespace candelabra::lighting
