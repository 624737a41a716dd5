// SPDX-License-Identifier: Apache-2.0
// Finds the instances that may be in the view: one lane tests the bounds of one chunk of instances
// against the planes of the view and writes one bit per instance. The test is conservative: it may keep
// instances that are outside, but drops none that is inside. Without atomics the order of the instances
// stays that of the input.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/raster.h"

layout(local_size_x = CULL_INSTANCES_GROUP) in;
layout(push_constant, scalar) uniform Push
{
    CullInstancesParams params;
};
layout(scalar, binding = CULL_INSTANCES_CHUNKS) readonly buffer Chunks
{
    Chunk chunks[];
};
layout(scalar, binding = CULL_INSTANCES_BOUNDS) readonly buffer Bounds
{
    InstanceBounds bounds[];
};
layout(scalar, binding = CULL_INSTANCES_BITS) writeonly buffer Bits
{
    uvec2 bits[];
};
layout(scalar, binding = CULL_INSTANCES_COUNTS) writeonly buffer Counts
{
    uint counts[];
};

// Largest error of a sum of rounded products, relative to the magnitudes in it: 8 roundings of 2^-24,
// times a safety factor of 20.
const float SLACK = 1e-5;

bool mayBeVisible(InstanceBounds b)
{
    const vec3 center = (b.centerHi - params.cameraHi) + (b.centerLo - params.cameraLo);
    const float slack = SLACK * (abs(center.x) + abs(center.y) + abs(center.z) + b.extent.x +
                                 b.extent.y + b.extent.z);
    bool visible = true;
    for (int i = 0; i < 6; ++i) {
        const vec4 plane = params.planes[i];
        const float reach = dot(abs(plane.xyz), b.extent);
        visible = visible && !(dot(plane.xyz, center) + plane.w < -(reach + slack));
    }
    return visible;
}

void main()
{
    const uint index = gl_GlobalInvocationID.x;
    if (index >= params.chunkCount)
        return;
    const Chunk chunk = chunks[index];
    uvec2 visible = uvec2(0);
    for (uint i = 0; i < chunk.count; ++i) {
        const uint bit = mayBeVisible(bounds[chunk.firstInstance + i]) ? 1u << (i & 31u) : 0u;
        visible |= i < 32u ? uvec2(bit, 0) : uvec2(0, bit);
    }
    bits[index] = visible;
    counts[index] = bitCount(visible.x) + bitCount(visible.y);
}
