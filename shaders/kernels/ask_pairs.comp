// SPDX-License-Identifier: Apache-2.0
// Asks for the visibility of every light in the lists of tiles and slices: makes a record and gives
// out a slot for each (shared/occluder_data.h). The lights of a page have consecutive slots. If a list
// finds too few, it becomes one that has no page: its pixels walk the light tree.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/occluder_data.h"

layout(local_size_x = ASK_PAIRS_GROUP) in;
layout(push_constant, scalar) uniform Push
{
    AskPairsParams params;
};
layout(scalar, binding = ASK_PAIRS_CLUSTERS) readonly buffer Clusters
{
    Cluster clusters[];
};
layout(scalar, binding = ASK_PAIRS_TILES) buffer Tiles
{
    TileClusters tiles[];
};
layout(scalar, binding = ASK_PAIRS_SPLITS) readonly buffer Splits
{
    WorkList splits;
};
layout(scalar, binding = ASK_PAIRS_LISTS) buffer Lists
{
    uint lists[];
};
layout(scalar, binding = ASK_PAIRS_ENTRIES) readonly buffer Entries
{
    uint entries[];
};
layout(scalar, binding = ASK_PAIRS_COUNTERS) buffer Counters
{
    LightingCounters counters;
};
layout(scalar, binding = ASK_PAIRS_SHADOW_COUNTERS) buffer ShadowCounterBuffer
{
    ShadowCounters shadowCounters;
};
layout(scalar, binding = ASK_PAIRS_UNLISTED) buffer Unlisted
{
    WorkList unlisted[TILE_WORK_LISTS];
    uint unlistedTiles[];
};
layout(scalar, binding = ASK_PAIRS_RECORDS) buffer Records
{
    WorkList asked;
    AskRecord records[];
};
layout(scalar, binding = SHADOW_PAGE_SLOTS) writeonly buffer PageSlots
{
    uint pageSlots[];
};

#include "kernels/common/tile_work_lists.glsl"

// Appends a tile to the work lists of shade_unlisted, and counts the cluster.
void appendUnlisted(uint tile)
{
    atomicAdd(counters.unlistedClusters, 1u);
    APPEND_TILE(unlisted, unlistedTiles, tile, UNLISTED_BITS, ANY_HEIGHT)
}

shared uint firstSlot; // of the present page

// Takes `count` slots and returns the first. Sets up the groups of pair_visibility that the records
// need.
uint takeSlots(uint count)
{
    const uint first = atomicAdd(asked.count, count);
    if (first + count <= params.capacity) {
        atomicMax(asked.groupsY, (first + count + ASK_ROW - 1u) / ASK_ROW);
        atomicMax(asked.first, first + count);
        atomicMax(shadowCounters.slots, first + count);
    } else
        atomicAdd(shadowCounters.missingSlots, count);
    return first;
}

void main()
{
    const uint at = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    const bool isSlice = at >= params.tileCount;
    const uint slice = at - params.tileCount;
    if (isSlice && slice >= min(splits.count, params.splitCapacity) * SLICES)
        return;
    const uint cluster = isSlice ? params.firstSplit + slice : at;
    if (!isSlice && (tiles[at].shift != UNSPLIT || tiles[at].lowest > tiles[at].highest))
        return;
    if (clusters[cluster].min.x > clusters[cluster].max.x) // an empty slice, which has no list
        return;
    uint page = lists[cluster];
    if (page == LIST_EMPTY || page == LIST_UNLISTED || page == LIST_LONG)
        return;
    const uint lane = gl_LocalInvocationIndex;
    const uint tile = clusters[cluster].tile;
    bool fits = true;
    while (page != 0u) {
        const uint header = entries[page * PAGE_WORDS];
        const uint count = header & ((1u << PAGE_COUNT_BITS) - 1u);
        if (lane == 0u) {
            firstSlot = takeSlots(count);
            pageSlots[page] = firstSlot;
        }
        barrier();
        const uint first = firstSlot;
        fits = fits && first + count <= params.capacity;
        if (fits && lane < count)
            records[first + lane] = AskRecord(tile, cluster, entries[page * PAGE_WORDS + 1u + lane]);
        page = header >> PAGE_COUNT_BITS;
        barrier(); // before firstSlot is written again
    }
    if (!fits && lane == 0u) {
        lists[cluster] = LIST_UNLISTED;
        appendUnlisted(tile);
    }
}
