// SPDX-License-Identifier: Apache-2.0
// Finds which share of a light the pixels of a tile see between the occluders. A group of lanes takes a
// pair of tile or slice and light, and each lane a pixel. All lanes walk for the same light.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernels/common/shade_receiver.glsl"
#include "lib/tile_pixels.glsl"
#include "shading/occluder_buffers.glsl"
#include "shared/cluster_data.h"

layout(local_size_x = TILE_SIZE, local_size_y = TILE_SIZE) in;
layout(push_constant, scalar) uniform Push
{
    PairVisibilityParams params;
};
layout(scalar, binding = SHADE_TILES) readonly buffer Tiles
{
    TileClusters tiles[];
};
layout(scalar, binding = VISIBILITY_RECORDS) readonly buffer Records
{
    WorkList asked;
    AskRecord records[];
};
layout(scalar, binding = SHADOW_SLOTS) writeonly buffer Slots
{
    uint slots[];
};

layout(scalar, binding = SHADE_COUNTERS) buffer Counters
{
    ShadowCounters shadowCounters;
};

#define QUEUE_LANES (TILE_SIZE * TILE_SIZE)
#include "shading/light_visibility.glsl"
#include "kernels/common/depth_error.glsl"

void main()
{
    const bool ofBatch = params.batch.count != 0u;
    AskRecord ask;
    uint slot;
    uvec2 pixel = pixelOfLane(gl_LocalInvocationIndex);
    if (ofBatch) {
        const uint tile = gl_WorkGroupID.y * params.tileCountX + gl_WorkGroupID.x;
        slot = tile * params.batch.count + gl_WorkGroupID.z;
        ask = AskRecord(0u, 0u, params.batch.first + gl_WorkGroupID.z);
        pixel += params.first + TILE_SIZE * gl_WorkGroupID.xy;
    } else {
        slot = gl_WorkGroupID.y * ASK_ROW + gl_WorkGroupID.x;
        if (slot >= asked.first)
            return;
        ask = records[slot];
        pixel += firstPixelOfTile(ask.tile, frameParams.size.x);
    }
    const bool inside = all(lessThan(pixel, frameParams.size));
    const float depth =
        inside ? texelFetch(depthImage, ivec2(pixel), 0).x : frameParams.clearDepth;
    bool asks = depth != frameParams.clearDepth;
    if (!ofBatch)
        asks = asks && tiles[ask.tile].first + ((depthBits(depth) - tiles[ask.tile].lowest) >>
                                                 tiles[ask.tile].shift) == ask.cluster;
    const ShadingPoint p = readShadingPoint(min(pixel, frameParams.size - 1u), depth);
    asks = asks && reachesPoint(ask.light, p);
    bool isFinished;
    slots[slot * SLOT_WORDS + gl_LocalInvocationIndex] =
        lightVisibility(ask.light, p, depthErrorAt(pixel, depth, p.position), asks, isFinished);
    if (!isFinished)
        atomicAdd(shadowCounters.unfinished, 1u);
}
