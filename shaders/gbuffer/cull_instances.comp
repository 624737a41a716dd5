// SPDX-License-Identifier: Apache-2.0
// Finds the instances that may be in the view: one lane tests the bounds of one chunk of instances
// against the planes of the view and writes one bit per instance and level of detail. The test is
// conservative: it may keep instances that are outside, but drops none that is inside. An instance is
// drawn by the coarsest level whose error is small enough in the image. Without atomics the order of
// the instances stays that of the input.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "gbuffer/slack.glsl"
#include "shared/raster.h"

layout(local_size_x = CULL_INSTANCES_GROUP) in;
layout(scalar, binding = CULL_INSTANCES_FRAME) uniform FrameBuffer
{
    CullInstancesFrame frame;
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

// Bounds relative to the camera.
struct View {
    vec3 center;
    vec3 extent;
    float slack; // largest rounding error of a distance, m
};

View viewOf(InstanceBounds b)
{
    const vec3 center = (b.centerHi - frame.cameraHi) + (b.centerLo - frame.cameraLo);
    const vec3 sizes = abs(center) + b.extent;
    return View(center, b.extent, SLACK * (sizes.x + sizes.y + sizes.z));
}

bool mayBeVisible(View b)
{
    bool visible = true;
    for (int i = 0; i < 6; ++i) {
        const vec4 plane = frame.planes[i];
        const float reach = dot(abs(plane.xyz), b.extent);
        visible = visible && !(dot(plane.xyz, b.center) + plane.w < -(reach + b.slack));
    }
    return visible;
}

// Returns x such that a length of at most x metres is nowhere in the bounds more than maxLevelError
// pixels long. A length d at depth z is at most pixelScale * d / z long in the middle of the image. At
// an angle to the viewing direction it may be longer by its secant, the distance over the depth.
float allowedError(View b)
{
    const vec3 center = b.center - frame.eye;
    const float depth = dot(frame.forward, center) - dot(abs(frame.forward), b.extent) - b.slack;
    const float distance = length(center) + length(b.extent);
    // Without an early return: in the loop of main(), llvmpipe runs one at a fifth of the speed.
    const float inFront = depth > 0.0 ? depth * (depth / distance) : 0.0;
    const float scale = frame.perspective == 0.0 ? 1.0 : inFront;
    return (1.0 - SLACK) * frame.maxLevelError * scale / frame.pixelScale;
}

// The number of coarser levels that are good enough; their errors ascend. An error must be less than
// `allowed`, not equal: where that is 0, no level is good enough, but the smallest errors are denormal
// floats, which devices may take for 0. All levels are tried, because a loop that ends early would be
// another loop of unknown length in that of main().
uint levelOf(Chunk chunk, float allowed, float scale)
{
    uint level = 0u;
    for (uint i = 0u; i < MESH_LEVELS - 1u; ++i)
        level += i + 1u < chunk.levelCount && chunk.levelErrors[i] * scale < allowed ? 1u : 0u;
    return level;
}

void main()
{
    const uint index = gl_GlobalInvocationID.x;
    if (index >= frame.chunkCount)
        return;
    const Chunk chunk = chunks[index];
    uvec2 drawn[MESH_LEVELS];
    for (uint level = 0u; level < MESH_LEVELS; ++level)
        drawn[level] = uvec2(0);
    for (uint i = 0; i < chunk.count; ++i) {
        const InstanceBounds instance = bounds[chunk.firstInstance + i];
        const View view = viewOf(instance);
        const uint chosen = levelOf(chunk, allowedError(view), instance.scale);
        const uint bit = mayBeVisible(view) ? 1u << (i & 31u) : 0u;
        const uvec2 word = i < 32u ? uvec2(bit, 0) : uvec2(0, bit);
        // Without a variable index, which would put the array into memory.
        for (uint level = 0u; level < MESH_LEVELS; ++level)
            drawn[level] |= level == chosen ? word : uvec2(0);
    }
    for (uint level = 0u; level < MESH_LEVELS; ++level) {
        bits[index * MESH_LEVELS + level] = drawn[level];
        counts[index * MESH_LEVELS + level] = bitCount(drawn[level].x) + bitCount(drawn[level].y);
    }
}
