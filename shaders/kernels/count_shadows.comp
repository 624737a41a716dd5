// SPDX-License-Identifier: Apache-2.0
// Counts what pair_visibility has found for the lights of one type: pairs of pixel and light whose
// visibility was asked for, and how many pixels see a part of the light, or nothing of it.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernels/common/frame_params.glsl"
#include "kernels/common/page_header.glsl"
#include "kernels/common/tile_of_group.glsl"
#include "kernels/common/count_in_64_bits.glsl"
#include "shared/occluder_data.h"

layout(local_size_x = TILE_SIZE, local_size_y = TILE_SIZE) in;
layout(push_constant, scalar) uniform Push
{
    CountShadowsParams params;
};
layout(binding = SHADE_DEPTH) uniform texture2D depthImage;
layout(scalar, binding = SHADE_ENTRIES) readonly buffer Entries
{
    uint entries[];
};
layout(scalar, binding = SHADOW_SLOTS) readonly buffer Slots
{
    uint slots[];
};
#include "kernels/common/slot_of_entry.glsl"
layout(scalar, binding = SHADE_COUNTERS) buffer Counters
{
    ShadowCounters counters;
};
layout(binding = SHADE_PAIRS, rgba32f) uniform image2D shadowImage;

struct Counts {
    uint asked, partly, dark;
};

void addSlot(inout Counts counts, uint slot)
{
    const uint shares = slots[slot * SLOT_WORDS + gl_LocalInvocationIndex];
    counts.asked += shares != SHARES_UNASKED ? 1u : 0u;
    counts.dark += shares == 0u ? 1u : 0u;
    counts.partly += shares != SHARES_UNASKED && shares != SHARES_LIT && shares != 0u ? 1u : 0u;
}

void addPage(inout Counts counts, uint page, uint count)
{
    for (uint i = 0u; i < count; ++i) {
        const uint slot = slotOfEntry(page * PAGE_WORDS + 1u + i);
        if (slot < SLOT_DARK)
            addSlot(counts, slot);
    }
}

void main()
{
    uint tile;
    uvec2 pixel;
    const bool inside = takeTile(tile, pixel);
    const float depth =
        inside ? texelFetch(depthImage, depthTexelOf(pixel), 0).x : frameParams.clearDepth;
    Counts counts = Counts(0u, 0u, 0u);
    if (depth != frameParams.clearDepth) {
        uint page = 0u;
        if (params.isDistant != 0u)
            for (uint i = 0u; i < params.batch.count; ++i)
                addSlot(counts, params.firstSlot + tile * params.batch.count + i);
        else
            page = lists[clusterOf(tile, depth)];
        while (page != LIST_EMPTY && page != LIST_UNLISTED && page != LIST_LONG) {
            const uint header = entries[page * PAGE_WORDS];
            addPage(counts, page, lightsOfPage(header));
            page = pageAfter(header);
        }
        if (params.writesImage != 0u)
            imageStore(shadowImage, texelOf(pixel),
                       imageLoad(shadowImage, texelOf(pixel)) +
                           vec4(counts.asked, counts.partly, counts.dark, 0.0));
    }
    COUNT(counters.asked, counts.asked)
    COUNT(counters.partly, counts.partly)
    COUNT(counters.dark, counts.dark)
}
