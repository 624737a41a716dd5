// SPDX-License-Identifier: Apache-2.0
// Lights in a buffer on the device that the host fills (CndDeviceLights).
#ifndef CND_SHARED_DEVICE_LIGHT_DATA_H
#define CND_SHARED_DEVICE_LIGHT_DATA_H

#include "shared/prelude.h"

GPU_BEGIN

// The same members as CndDeviceLight.
struct DeviceLight {
    vec3 position;
    float radius;
    vec3 emission;
    float influenceRadius;
};
GPU_SIZE(DeviceLight, 32)

// The numbers of lights that were valid and taken, and that were not valid.
struct DeviceLightCounts {
    uint taken, rejected;
};
GPU_SIZE(DeviceLightCounts, 8)

// --- device_lights: writes the first records of the light set, one lane per light
const uint DEVICE_LIGHTS_GROUP = 64u;
const uint DEVICE_LIGHTS_FROM = 0u;
const uint DEVICE_LIGHTS_COUNT = 1u;
const uint DEVICE_LIGHTS_RECORDS = 2u;
const uint DEVICE_LIGHTS_COUNTS = 3u; // DeviceLightCounts, cleared before the dispatch
struct DeviceLightsParams {
    uint type; // LIGHT_*
    uint maxCount;
    uint hasCount; // 0: there are maxCount lights
    uint layers;   // of all these lights: LightRecord::flags >> LIGHT_LAYERS_SHIFT
};
GPU_SIZE(DeviceLightsParams, 16)

GPU_END

#endif
