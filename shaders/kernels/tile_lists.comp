// SPDX-License-Identifier: Apache-2.0
// Exact list of lights per tile, in light order: count, allocate, fill. A group is 8x8 tiles inside
// one coarse tile, so its lanes walk the same mask words. Where a list lies in the buffer depends on
// the schedule, what it holds does not; a group that does not fit is marked UNLISTED and shaded by
// walking all lights, with the same result.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/lighting.h"
#include "lib/bounds.glsl"
#define LIGHT_STREAM_CORE TILE_LISTS_CORE
#define LIGHT_STREAM_CORE_WORDS TILE_LISTS_CORE_WORDS
#include "lib/light_stream.glsl"

layout(local_size_x = TILE_LISTS_GROUP_X, local_size_y = TILE_LISTS_GROUP_Y) in;
layout(push_constant, scalar) uniform Push
{
    TileListsParams params;
};
layout(scalar, binding = TILE_LISTS_BOUNDS) readonly buffer Bounds
{
    TileBounds bounds[];
};
layout(scalar, binding = TILE_LISTS_MASKS) readonly buffer Masks
{
    uint masks[];
};
layout(scalar, binding = TILE_LISTS_LISTS) buffer Lists
{
    TileList lists[];
};
layout(scalar, binding = TILE_LISTS_ENTRIES) writeonly buffer Entries
{
    uint entries[];
};
layout(scalar, binding = TILE_LISTS_COUNTERS) buffer Counters
{
    LightingCounters counters;
};

const uint GROUP = TILE_LISTS_GROUP_X * TILE_LISTS_GROUP_Y;
shared uint counts[GROUP];
shared uint starts[GROUP];

// Reserves `total` entries; UNLISTED when they do not fit. Compare-and-swap, so the cursor never
// passes the capacity and cannot wrap.
uint reserve(uint total)
{
    uint start = atomicAdd(counters.listCursor, 0u);
    while (total <= params.capacity - start) {
        const uint seen = atomicCompSwap(counters.listCursor, start, start + total);
        if (seen == start)
            return start;
        start = seen;
    }
    return UNLISTED;
}

void main()
{
    const uvec2 tileXY = gl_GlobalInvocationID.xy;
    const bool inside = tileXY.x < params.tileCountX && tileXY.y < params.tileCountY;
    const uint tile = tileXY.y * params.tileCountX + tileXY.x;
    const uint lane = gl_LocalInvocationIndex;
    TileBounds box = TileBounds(vec3(1.0), vec3(0.0));
    if (inside)
        box = bounds[tile];
    const bool empty = isEmpty(box);
    const uvec2 coarse = gl_WorkGroupID.xy * TILE_LISTS_GROUP_X / params.factor;
    const uint firstWord = (coarse.y * params.coarseCountX + coarse.x) * params.wordCount;

    uint count = 0u;
    for (uint word = 0u; word < params.wordCount; ++word)
        for (uint mask = masks[firstWord + word]; mask != 0u; mask &= mask - 1u) {
            const uint light = params.firstLight + word * MASK_BITS + findLSB(mask);
            count += sphereTouches(box, lightCentre(light).xyz, lightEmission(light).w) ? 1u : 0u;
        }
    count = empty ? 0u : count;
    counts[lane] = count;
    barrier();
    if (lane == 0u) {
        uint total = 0u;
        for (uint i = 0u; i < GROUP; ++i)
            total += counts[i];
        uint start = reserve(total);
        atomicAdd(counters.listEntries, start == UNLISTED ? 0u : total);
        for (uint i = 0u; i < GROUP; ++i) {
            starts[i] = start;
            start += start == UNLISTED ? 0u : counts[i];
        }
    }
    barrier();
    if (!inside)
        return;
    const uint start = starts[lane];
    const bool listed = start != UNLISTED || empty;
    TileList list = lists[tile];
    if (params.firstLight == 0u)
        list.total = list.everUnlisted = 0u;
    if (!listed && list.everUnlisted == 0u)
        atomicAdd(counters.unlistedTiles, 1u);
    list.offset = listed ? start : UNLISTED;
    list.count = listed ? count : params.lightCount;
    list.total += count;
    list.everUnlisted |= listed ? 0u : 1u;
    lists[tile] = list;
    atomicMax(counters.maxListLength, list.total);
    if (empty || !listed)
        return;
    uint at = start;
    for (uint word = 0u; word < params.wordCount; ++word)
        for (uint mask = masks[firstWord + word]; mask != 0u; mask &= mask - 1u) {
            const uint light = params.firstLight + word * MASK_BITS + findLSB(mask);
            if (sphereTouches(box, lightCentre(light).xyz, lightEmission(light).w)) {
                entries[at] = light;
                ++at;
            }
        }
}
