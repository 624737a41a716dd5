// SPDX-License-Identifier: Apache-2.0
#include "lights/device_lights.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>

#include "candelabra_shaders.h"
#include "lights/influence_box.h"

namespace candelabra::lighting
{
namespace
{

static_assert(sizeof(CndDeviceLight) == sizeof(gpu::DeviceLight) &&
              offsetof(CndDeviceLight, radius) == offsetof(gpu::DeviceLight, radius) &&
              offsetof(CndDeviceLight, emission) == offsetof(gpu::DeviceLight, emission) &&
              offsetof(CndDeviceLight, influenceRadius) ==
                  offsetof(gpu::DeviceLight, influenceRadius));

void checkOffset(const gpu::Device& device, const char* name, VkDeviceSize offset)
{
    const VkDeviceSize alignment = device.limits.minStorageBufferOffsetAlignment;
    if (offset % alignment)
        gpu::failArgument(std::string("CndDeviceLights: ") + name + " " + std::to_string(offset) +
                          " is no multiple of minStorageBufferOffsetAlignment, " +
                          std::to_string(alignment));
}

} // namespace

void checkDeviceLights(const gpu::Device& device, const CndDeviceLights& lights)
{
    if (lights.type != CND_LIGHT_POINT && lights.type != CND_LIGHT_SPHERE)
        gpu::failArgument("CndDeviceLights: type must be CND_LIGHT_POINT or CND_LIGHT_SPHERE, is " +
                          std::to_string(lights.type));
    if (!lights.maxCount || !lights.buffer)
        gpu::failArgument("CndDeviceLights: maxCount and buffer may not be 0");
    const VkDeviceSize bytes = VkDeviceSize(lights.maxCount) * sizeof(CndDeviceLight);
    if (bytes > device.limits.maxStorageBufferRange)
        gpu::failUnsupported("CndDeviceLights: " + std::to_string(lights.maxCount) +
                             " lights exceed the device's maxStorageBufferRange " +
                             std::to_string(device.limits.maxStorageBufferRange));
    checkOffset(device, "offset", lights.offset);
    checkOffset(device, "countOffset", lights.countOffset);
    for (int axis = 0; axis < 3; ++axis)
        if (!(std::isfinite(lights.boundsMin[axis]) && std::isfinite(lights.boundsMax[axis]) &&
              lights.boundsMin[axis] <= lights.boundsMax[axis]))
            gpu::failArgument("CndDeviceLights: boundsMin and boundsMax must be finite, and "
                              "boundsMin not above boundsMax");
    if (!(lights.influenceRadius > 0))
        gpu::failArgument("CndDeviceLights: influenceRadius must be > 0");
    if (!areLayers(lights.layers))
        gpu::failArgument("CndDeviceLights: layers has bits beyond CND_LAYER_COUNT");
    if (lights.unshadowedBy >> CND_OCCLUDER_LAYER_COUNT)
        gpu::failArgument("CndDeviceLights: unshadowedBy has bits beyond "
                          "CND_OCCLUDER_LAYER_COUNT");
}

LightExtent extentWith(const LightExtent& host, size_t placed, const CndDeviceLights& device)
{
    LightExtent out;
    for (int axis = 0; axis < 3; ++axis) {
        const float hostLow = placed ? host.low[axis] : device.boundsMin[axis];
        const float hostHigh = placed ? host.low[axis] + host.size : device.boundsMax[axis];
        out.low[axis] = std::min(hostLow, device.boundsMin[axis]);
        const float side = std::max(hostHigh, device.boundsMax[axis]) - out.low[axis];
        out.size = axis ? std::max(out.size, side) : side;
    }
    out.size = std::max(out.size, gpu::MIN_LIGHT_LENGTH);
    out.influenceRadius = placed > device.maxCount ? host.influenceRadius : device.influenceRadius;
    return out;
}

DeviceLights::DeviceLights(const gpu::Device& device)
    : kernel_(device, spirv::device_lights_comp),
      counts_(gpu::createBuffer(device, "device light counts", sizeof(gpu::DeviceLightCounts),
                                VK_BUFFER_USAGE_STORAGE_BUFFER_BIT |
                                    VK_BUFFER_USAGE_TRANSFER_SRC_BIT |
                                    VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                                gpu::MemoryUse::Device))
{
}

std::shared_ptr<gpu::Bindings> DeviceLights::prepare(const CndDeviceLights& lights,
                                                     bool newRecords) const
{
    const bool same = bindings_ && !newRecords && lights.buffer == lights_.buffer &&
                      lights.offset == lights_.offset && lights.maxCount == lights_.maxCount &&
                      lights.countBuffer == lights_.countBuffer &&
                      lights.countOffset == lights_.countOffset;
    return same ? nullptr : std::make_shared<gpu::Bindings>(kernel_.createBindings(1));
}

void DeviceLights::take(const CndDeviceLights& lights, const gpu::Buffer& records,
                        std::shared_ptr<gpu::Bindings> bindings)
{
    if (bindings) {
        bindings_ = std::move(bindings);
        write(lights, records);
    }
    lights_ = lights;
    present_ = true;
}

void DeviceLights::write(const CndDeviceLights& lights, const gpu::Buffer& records) const
{
    gpu::Binding from{.binding = gpu::DEVICE_LIGHTS_FROM,
                      .buffer = lights.buffer,
                      .offset = lights.offset,
                      .range = VkDeviceSize(lights.maxCount) * sizeof(CndDeviceLight)};
    // Without a count buffer the kernel does not read this binding.
    gpu::Binding count = gpu::Binding::of(gpu::DEVICE_LIGHTS_COUNT, counts_);
    if (lights.countBuffer)
        count = {.binding = gpu::DEVICE_LIGHTS_COUNT,
                 .buffer = lights.countBuffer,
                 .offset = lights.countOffset,
                 .range = sizeof(uint32_t)};
    bindings_->write(0, {from, count, gpu::Binding::of(gpu::DEVICE_LIGHTS_RECORDS, records),
                         gpu::Binding::of(gpu::DEVICE_LIGHTS_COUNTS, counts_)});
}

void DeviceLights::recordReset(const gpu::Frame& frame) const noexcept
{
    frame.device.CmdFillBuffer(frame.cmd, counts_.get(), 0, VK_WHOLE_SIZE, 0);
}

void DeviceLights::record(const gpu::Frame& frame) const noexcept
{
    kernel_.dispatch(frame, bindings_->set(0),
                     {.type = lights_.type,
                      .maxCount = lights_.maxCount,
                      .hasCount = lights_.countBuffer != VK_NULL_HANDLE,
                      .layers = layersOf(lights_.layers) |
                                (flagsOfShadows(lights_.unshadowed, lights_.unshadowedBy) >>
                                 gpu::LIGHT_LAYERS_SHIFT)},
                     gpu::divideUp(lights_.maxCount, gpu::DEVICE_LIGHTS_GROUP));
}

} // namespace candelabra::lighting
