// SPDX-License-Identifier: Apache-2.0
// The bindings of cluster_lists, the cluster of each list that it makes, and the work lists of tiles
// that it fills.
#ifndef CND_COMMON_CLUSTER_OF_LIST
#define CND_COMMON_CLUSTER_OF_LIST

#include "kernels/common/light_stream.glsl"
#include "kernels/common/light_tree.glsl"
#include "shared/cluster_data.h"

layout(push_constant, scalar) uniform Push
{
    ClusterListsParams params;
};
layout(scalar, binding = CLUSTER_LISTS_CLUSTERS) readonly buffer Clusters
{
    Cluster clusters[];
};
layout(scalar, binding = CLUSTER_LISTS_TILES) buffer Tiles
{
    TileClusters tiles[];
};
layout(scalar, binding = CLUSTER_LISTS_SPLITS) readonly buffer Splits
{
    WorkList splits;
};
layout(scalar, binding = CLUSTER_LISTS_LISTS) buffer Lists
{
    uint lists[];
};
layout(scalar, binding = CLUSTER_LISTS_ENTRIES) buffer Entries
{
    uint entries[];
};
layout(scalar, binding = CLUSTER_LISTS_COUNTERS) buffer Counters
{
    LightingCounters counters;
};
layout(scalar, binding = CLUSTER_LISTS_LIT) buffer Lit
{
    WorkList lit[TILE_WORK_LISTS];
    uint litTiles[];
};
layout(scalar, binding = CLUSTER_LISTS_UNLISTED) buffer Unlisted
{
    WorkList unlisted[TILE_WORK_LISTS];
    uint unlistedTiles[];
};

// Sets `at` to the cluster of a list. Lists are counted from 0 in each dispatch. Returns false if there
// is none.
bool clusterOfList(uint list, out uint at)
{
    at = params.firstCluster + list;
    if (params.which != LISTS_OF_TILES)
        return list < (params.which == LISTS_OF_BLOCKS
                           ? params.clusterCount
                           : min(splits.count * SLICES, params.clusterCount));
    const uint perBlock = BLOCK_SIDE * BLOCK_SIDE;
    const uint blocksX = (params.tileCountX + BLOCK_SIDE - 1u) / BLOCK_SIDE;
    const uint block = list / perBlock, inBlock = list % perBlock;
    const uvec2 tile = BLOCK_SIDE * uvec2(block % blocksX, block / blocksX) +
                       uvec2(inBlock % BLOCK_SIDE, inBlock / BLOCK_SIDE);
    if (any(greaterThanEqual(tile, uvec2(params.tileCountX, params.tileCountY))))
        return false;
    at = tile.y * params.tileCountX + tile.x;
    return tiles[at].first == at && tiles[at].shift == UNSPLIT &&
           tiles[at].lowest <= tiles[at].highest;
}

#include "kernels/common/tile_work_lists.glsl"

// Appends a tile to the work lists of shade_tiles.
void appendLit(uint tile, uint height)
{
    APPEND_TILE(lit, litTiles, tile, LIT_BITS, height)
}

// Appends the parts of a list to the work list of its tile. Returns the place of the first one.
uint appendParts(uint tile, uint height, uint entry, uint parts)
{
    const uint work = height * TILE_CLASSES + (tiles[tile].onLists >> CLASS_BITS);
    const uint before = atomicAdd(lit[work].count, parts);
    const uint rows = (before + TILE_ROW - 1u) / TILE_ROW;
    atomicAdd(lit[work].groupsY, (before + parts + TILE_ROW - 1u) / TILE_ROW - rows);
    const uint first = lit[work].first + before;
    for (uint i = 0u; i < parts; ++i)
        litTiles[first + i] = entry;
    return first;
}

#include "kernels/common/append_unlisted.glsl"

#endif
