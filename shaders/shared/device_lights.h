// SPDX-License-Identifier: Apache-2.0
// Lights in a buffer of the host's on the device.
#ifndef CND_SHARED_DEVICE_LIGHTS_H
#define CND_SHARED_DEVICE_LIGHTS_H

#include "shared/prelude.h"

GPU_BEGIN

// CndDeviceLight.
struct DeviceLight {
    vec3 position;
    float radius;
    vec3 emission;
    float influenceRadius;
};
GPU_SIZE(DeviceLight, 32)

// Beyond these the squares of lengths are no numbers.
const float MAX_LIGHT_COORDINATE = 1e15f;
const float MIN_LIGHT_LENGTH = 1e-15f;

struct DeviceLightCounts {
    uint taken, rejected;
};
GPU_SIZE(DeviceLightCounts, 8)

// --- device_lights: into the first records of the light set, one lane per light
const uint DEVICE_LIGHTS_GROUP = 64u;
const uint DEVICE_LIGHTS_FROM = 0u;
const uint DEVICE_LIGHTS_COUNT = 1u;
const uint DEVICE_LIGHTS_RECORDS = 2u;
const uint DEVICE_LIGHTS_COUNTS = 3u; // cleared before
struct DeviceLightsParams {
    uint type; // LIGHT_*
    uint maxCount;
    uint hasCount; // 0: there are maxCount lights
    uint layers;   // of all of them
};
GPU_SIZE(DeviceLightsParams, 16)

GPU_END

#endif
