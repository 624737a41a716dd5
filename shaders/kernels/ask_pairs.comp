// SPDX-License-Identifier: Apache-2.0
// Asks for the visibility of every light in the lists of tiles and slices: makes an AskRecord for
// each (shared/occluder_data.h). The records of a page are consecutive. If a list finds no room for its
// records, it becomes one that has no page: its pixels walk the light tree. Also finds the bounds of
// the samples of these clusters.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#include "kernels/common/frame_params.glsl"
#include "kernels/common/page_header.glsl"
#include "lib/ordered_bits.glsl"
#include "lib/tile_pixels.glsl"
#include "lib/visibility/own_surface.glsl"
#include "shading/shadow_view.glsl"

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
layout(scalar, binding = SHADOW_PAGE_PAIRS) writeonly buffer PagePairs
{
    uint pagePairs[];
};
layout(binding = ASK_PAIRS_DEPTH) uniform texture2D depthImage;
layout(scalar, binding = ASK_PAIRS_BOUNDS) writeonly buffer Bounds
{
    SampleBounds bounds[];
};

#define ASKED_PAIRS ASK_PAIRS_ASKED
#define ASKED_ACCESS
#include "kernels/common/asked_pairs.glsl"
#include "kernels/common/cluster_of_depth.glsl"
#include "kernels/common/depth_error.glsl"
#include "kernels/common/append_unlisted.glsl"

shared uint firstRecord; // of the present page

// Returns whether there is room for all records before `end`.
bool haveRoom(uint end)
{
    return end <= min(PAIRS_PER_SLOT * params.capacity, MOST_PAIRS);
}

// Takes room for `count` records and returns the first. Sets up the groups of list_occluders that
// they need.
uint takeRecords(uint count)
{
    const uint first = atomicAdd(asked.taken, count);
    const uint end = first + count;
    if (haveRoom(end)) {
        atomicMax(asked.groups[1], (end - asked.first + ASK_ROW - 1u) / ASK_ROW);
        atomicMax(asked.written, end);
        atomicAdd(shadowCounters.pairs, count);
    } else
        atomicAdd(shadowCounters.missingPairs, count);
    return first;
}

void writeRecord(uint pair, uint tile, uint cluster, uint light)
{
    const uint at = placeOfPair(pair);
    askedWords[at] = tile;
    askedWords[at + 1u] = cluster;
    askedWords[at + 2u] = light;
}

// The lowest of each coordinate, of its negative, of the own distance, and of its negative, as
// orderedBits().
shared uint least[8];

// All lanes of the group must call it. isSample: false: the lane has no value.
void findLeast(uint what, float value, bool isSample)
{
    const uint lowest = subgroupMin(isSample ? orderedBits(value) : 0xFFFFFFFFu);
    if (subgroupElect())
        atomicMin(least[what], lowest);
}

// Finds the bounds of the cluster's samples. All lanes of the group must call it, each for a pixel.
void findBounds(uint tile, uint cluster)
{
    const uint lane = gl_LocalInvocationIndex;
    if (lane < 8u)
        least[lane] = 0xFFFFFFFFu;
    barrier();
    const uvec2 pixel = firstPixelOfTile(tile, frameParams.size.x) + pixelOfLane(lane);
    const bool inside = all(lessThan(pixel, frameParams.size));
    const float depth =
        inside ? texelFetch(depthImage, depthTexelOf(pixel), 0).x : frameParams.clearDepth;
    const bool isSample = depth != frameParams.clearDepth && clusterOf(tile, depth) == cluster;
    const vec3 position =
        viewPosition(frameParams.projection, pixel, frameParams.invImageSize, depth);
    const vec3 inTree = position * shadowView.viewFromTree;
    for (uint k = 0u; k < 3u; ++k) {
        findLeast(k, inTree[k], isSample);
        findLeast(3u + k, -inTree[k], isSample);
    }
    const float depthError = depthErrorAt(pixel, depth, position);
    const float own = ownSurfaceDistance(depthError, position, 0.0, mat3(0.0), vec3(0.0));
    findLeast(6u, own, isSample);
    findLeast(7u, -own, isSample);
    barrier();
    if (lane == 0u)
        bounds[cluster] = SampleBounds(
            vec3(floatOfOrdered(least[0]), floatOfOrdered(least[1]), floatOfOrdered(least[2])),
            floatOfOrdered(least[6]),
            -vec3(floatOfOrdered(least[3]), floatOfOrdered(least[4]), floatOfOrdered(least[5])),
            -floatOfOrdered(least[7]));
}

// Returns the first page of the list of a tile (below params.tileCount) or slice, and its cluster.
// LIST_EMPTY: it has no page.
uint firstPage(uint at, out uint cluster)
{
    const bool isSlice = at >= params.tileCount;
    cluster = isSlice ? params.firstSplit + at - params.tileCount : at;
    if (!isSlice && (tiles[at].shift != UNSPLIT || tiles[at].lowest > tiles[at].highest))
        return LIST_EMPTY;
    if (clusters[cluster].min.x > clusters[cluster].max.x) // an empty slice, which has no list
        return LIST_EMPTY;
    const uint page = lists[cluster];
    return page == LIST_UNLISTED || page == LIST_LONG ? LIST_EMPTY : page;
}

// Asks for the lights of a list that has pages. All lanes of the group must call it.
void askForLights(uint cluster, uint page)
{
    const uint lane = gl_LocalInvocationIndex;
    const uint tile = clusters[cluster].tile;
    findBounds(tile, cluster);
    bool fits = true;
    do {
        const uint header = entries[page * PAGE_WORDS];
        const uint count = lightsOfPage(header);
        if (lane == 0u) {
            firstRecord = takeRecords(count);
            pagePairs[page] = firstRecord;
        }
        barrier();
        const uint first = firstRecord;
        fits = fits && haveRoom(first + count);
        if (fits && lane < count)
            writeRecord(first + lane, tile, cluster, entries[page * PAGE_WORDS + 1u + lane]);
        page = pageAfter(header);
        barrier(); // before firstRecord is written again
    } while (page != 0u);
    if (!fits && lane == 0u) {
        lists[cluster] = LIST_UNLISTED;
        appendUnlisted(tile);
    }
}

// Each group takes a tile and, if there are more slices than tiles, several slices.
void main()
{
    const uint end = params.tileCount + min(splits.count, params.splitCapacity) * SLICES;
    uint at = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    if (at >= params.tileCount)
        return;
    do {
        uint cluster;
        const uint page = firstPage(at, cluster);
        if (page != LIST_EMPTY)
            askForLights(cluster, page);
        at += params.tileCount;
    } while (at < end);
}
