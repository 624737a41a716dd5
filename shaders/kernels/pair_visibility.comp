// SPDX-License-Identifier: Apache-2.0
// Finds which share of a light the pixels of a tile see between the occluders. A group of lanes
// takes a pair of tile or slice and light, and each lane a pixel. All lanes walk for the same
// light.
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
#define ASKED_PAIRS VISIBILITY_ASKED
#define ASKED_ACCESS readonly
#include "kernels/common/asked_pairs.glsl"
layout(scalar, binding = SHADOW_SLOTS) writeonly buffer Slots
{
    uint slots[];
};

layout(scalar, binding = SHADE_COUNTERS) buffer Counters
{
    ShadowCounters shadowCounters;
};

#include "kernels/common/cluster_of_depth.glsl"
#include "kernels/common/depth_error.glsl"
#include "shading/light_visibility.glsl"

layout(constant_id = SPEC_PAIR_KIND) const uint pairKind = PAIRS_WALKED;

SlotRecord slotRecord(uint slot)
{
    const uint at = placeOfRecord(slot);
    return SlotRecord(askedWords[at], askedWords[at + 1u]);
}

#ifdef CANDELABRA_VISIBLE_POINTS
uint listedShares(uint light, uint items, ShadingPoint p, float depthError, bool asks)
{
    return SHARES_UNASKED; // no pair is listed
}
#else
uint occluderItem(uint item)
{
    return askedWords[placeOfItem(item)];
}
#include "shading/listed_occluders.glsl"

// Returns the visible shares of a pair that is listed. items: as in SlotRecord.
uint listedShares(uint light, uint items, ShadingPoint p, float depthError, bool asks)
{
    const uvec2 seen =
        listedPoints(occluderQuery(light, p, depthError), items >> ITEM_COUNT_BITS,
                     items & ((1u << ITEM_COUNT_BITS) - 1u), asks);
    return asks ? sharesOfPoints(light, p, seen) : SHARES_UNASKED;
}
#endif

void main()
{
    const bool ofBatch = params.batch.count != 0u;
    AskRecord ask;
    uint slot, items = 0u;
    uvec2 pixel = pixelOfLane(gl_LocalInvocationIndex);
    if (ofBatch) {
        const uint tile = gl_WorkGroupID.y * params.tileCountX + gl_WorkGroupID.x;
        slot = params.firstSlot + tile * params.batch.count + gl_WorkGroupID.z;
        ask = AskRecord(0u, 0u, params.batch.first + gl_WorkGroupID.z, 0u);
        pixel += params.first + TILE_SIZE * gl_WorkGroupID.xy;
    } else {
        const uint at = gl_WorkGroupID.y * ASK_ROW + gl_WorkGroupID.x;
        if (at >= asked.kinds[pairKind].count)
            return;
        slot = askedWords[placeOfSlot(pairKind, at)];
        const SlotRecord record = slotRecord(slot);
        ask = askRecord(record.pair);
        items = record.items;
        pixel += firstPixelOfTile(ask.tile, frameParams.size.x);
    }
    const bool inside = all(lessThan(pixel, frameParams.size));
    const float depth =
        inside ? texelFetch(depthImage, depthTexelOf(pixel), 0).x : frameParams.clearDepth;
    bool asks = depth != frameParams.clearDepth;
    if (!ofBatch)
        asks = asks && clusterOf(ask.tile, depth) == ask.cluster;
    const ShadingPoint p = readShadingPoint(min(pixel, frameParams.size - 1u), depth);
    asks = asks && reachesPoint(ask.light, p);
    const float depthError = depthErrorAt(pixel, depth, p.position);
    bool isFinished = true;
    uint shares;
    if (pairKind == PAIRS_LISTED)
        shares = listedShares(ask.light, items, p, depthError, asks);
    else
        shares = lightVisibility(ask.light, p, depthError, asks, isFinished);
    slots[slot * SLOT_WORDS + gl_LocalInvocationIndex] = shares;
    if (!isFinished)
        atomicAdd(shadowCounters.unfinished, 1u);
}
