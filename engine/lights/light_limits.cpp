// SPDX-License-Identifier: Apache-2.0
#include "lights/light_limits.h"

#include <algorithm>

#include "shared/lighting_data.h"

namespace candelabra::lighting
{

// Three things limit the number of lights: the largest range of a storage buffer, which holds the
// records; the largest dispatch of prepare_lights; and the 32-bit sums that count_pairs makes over
// the 64 pixels of a tile.
uint32_t maxLights(const VkPhysicalDeviceLimits& limits)
{
    constexpr uint64_t countable = UINT32_MAX / (gpu::TILE_SIZE * gpu::TILE_SIZE);
    const uint64_t stored = limits.maxStorageBufferRange / sizeof(gpu::LightRecord);
    const uint64_t dispatched =
        uint64_t(limits.maxComputeWorkGroupCount[0]) * gpu::PREPARE_LIGHTS_GROUP;
    return uint32_t(std::min({countable, stored, dispatched}));
}

bool texelBuffersSuffice(const VkPhysicalDeviceLimits& limits)
{
    return limits.maxTexelBufferElements / gpu::LIGHT_CORE_STRIDE >= maxLights(limits) &&
           limits.maxTexelBufferElements >= limits.maxStorageBufferRange / sizeof(uint32_t);
}

uint32_t forCpu(const gpu::Device& device)
{
    return device.lanesAreCpuVector && texelBuffersSuffice(device.limits);
}

} // namespace candelabra::lighting
