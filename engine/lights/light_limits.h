// SPDX-License-Identifier: Apache-2.0
// The number of lights that a device can take, and the kind of buffer from which its kernels read
// them.
#pragma once

#include "gpu/device.h"

namespace candelabra::lighting
{

// Returns the number of lights in the largest set that a device with these limits can take.
uint32_t maxLights(const VkPhysicalDeviceLimits& limits);

// Tells whether texel buffers of a device with these limits can hold maxLights() lights, and the
// largest buffer of list entries.
bool texelBuffersSuffice(const VkPhysicalDeviceLimits& limits);

// Returns the value of SPEC_FOR_CPU. It is 0 on GPUs. It is 1 on a device whose lanes are a CPU
// vector, if its texel buffers suffice: then kernels read lights and the entries of lists from
// texel buffers, read nothing ahead and keep nothing in shared memory
// (shaders/shading/software_drivers.glsl).
uint32_t forCpu(const gpu::Device& device);

} // namespace candelabra::lighting
