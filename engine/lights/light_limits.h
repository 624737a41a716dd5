// SPDX-License-Identifier: Apache-2.0
// How many lights a device can take, and as what kind of buffer its kernels read them.
#pragma once

#include "gpu/device.h"

namespace candelabra::lighting
{

// The largest light set that a device with these limits can take.
uint32_t maxLights(const VkPhysicalDeviceLimits& limits);

// The value of SPEC_LIGHTS_AS_TEXELS: 1 when kernels read lights from texel buffers, which is where
// texel buffers can hold as many lights as the other limits allow; else 0, storage buffers.
uint32_t lightsAsTexels(const gpu::Device& device);

} // namespace candelabra::lighting
