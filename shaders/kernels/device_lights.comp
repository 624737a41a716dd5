// SPDX-License-Identifier: Apache-2.0
// Turns the lights that the host wrote on the device into records. It applies the checks that the CPU
// applies to other lights. An invalid light becomes a record without influence, which is in no list and
// in no box of the light tree.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/device_light_data.h"
#include "shared/lighting_data.h"

layout(local_size_x = DEVICE_LIGHTS_GROUP) in;
layout(push_constant, scalar) uniform Push
{
    DeviceLightsParams params;
};
layout(scalar, binding = DEVICE_LIGHTS_FROM) readonly buffer From
{
    DeviceLight from[];
};
layout(scalar, binding = DEVICE_LIGHTS_COUNT) readonly buffer Count
{
    uint count;
};
layout(scalar, binding = DEVICE_LIGHTS_RECORDS) writeonly buffer Records
{
    LightRecord records[];
};
layout(scalar, binding = DEVICE_LIGHTS_COUNTS) buffer Counts
{
    DeviceLightCounts counts;
};

// Tells whether a light is valid. Every comparison is false for NaN.
bool isLight(DeviceLight light, float radius)
{
    const float largest = uintBitsToFloat(0x7F7FFFFFu);
    return all(lessThanEqual(abs(light.position), vec3(MAX_LIGHT_COORDINATE))) &&
           all(greaterThanEqual(light.emission, vec3(0.0))) &&
           all(lessThanEqual(light.emission, vec3(largest))) &&
           (params.type == LIGHT_POINT ||
            (radius >= MIN_LIGHT_LENGTH && radius <= MAX_LIGHT_COORDINATE)) &&
           light.influenceRadius > radius;
}

void main()
{
    const uint i = gl_GlobalInvocationID.x;
    if (i >= params.maxCount)
        return;
    const uint written = params.hasCount != 0u ? count : params.maxCount;
    // A record without a light is far away, so that no distance to it is 0.
    LightRecord record = LightRecord(vec3(MAX_LIGHT_COORDINATE), 0.0, vec3(0.0), 0.0, vec3(0.0),
                                     LIGHT_OF_DEVICE | i, vec3(0.0),
                                     params.type | params.layers << LIGHT_LAYERS_SHIFT);
    if (i < written) {
        const DeviceLight light = from[i];
        const float radius = params.type == LIGHT_POINT ? 0.0 : light.radius;
        if (isLight(light, radius)) {
            record.position = light.position;
            record.boundingRadius = radius;
            record.emission = light.emission;
            record.influenceRadius = min(light.influenceRadius, UNBOUNDED);
            atomicAdd(counts.taken, 1u);
        } else {
            atomicAdd(counts.rejected, 1u);
        }
    }
    records[i] = record;
    if (i == 0u && written > params.maxCount)
        atomicAdd(counts.rejected, written - params.maxCount);
}
