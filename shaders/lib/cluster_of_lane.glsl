// SPDX-License-Identifier: Apache-2.0
// Which cluster a lane of cluster_lists makes the list of, and where it notes that there is none. The
// includer provides params, counters, tiles[], splits, unlisted and unlistedTiles[].
#ifndef CND_LIB_CLUSTER_OF_LANE
#define CND_LIB_CLUSTER_OF_LANE

// The cluster of this lane; false without one.
bool takeCluster(out uint at)
{
    const uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    const uint lane = group * CLUSTER_LISTS_GROUP + gl_LocalInvocationIndex;
    at = params.firstCluster + lane;
    if (params.which != LISTS_OF_TILES)
        return lane < (params.which == LISTS_OF_BLOCKS
                           ? params.clusterCount
                           : min(splits.count * SLICES, params.clusterCount));
    const uint perBlock = BLOCK_SIDE * BLOCK_SIDE;
    const uint blocksX = (params.tileCountX + BLOCK_SIDE - 1u) / BLOCK_SIDE;
    const uint block = lane / perBlock, inBlock = lane % perBlock;
    const uvec2 tile = BLOCK_SIDE * uvec2(block % blocksX, block / blocksX) +
                       uvec2(inBlock % BLOCK_SIDE, inBlock / BLOCK_SIDE);
    if (any(greaterThanEqual(tile, uvec2(params.tileCountX, params.tileCountY))))
        return false;
    at = tile.y * params.tileCountX + tile.x;
    return tiles[at].first == at && tiles[at].shift == UNSPLIT &&
           tiles[at].lowest <= tiles[at].highest;
}

// The tile is listed once per light type, by whichever lane comes first.
void appendTile(uint tile)
{
    atomicAdd(counters.unlistedClusters, 1u);
    const uint bit = 1u << params.lightType;
    if ((atomicOr(tiles[tile].unlisted, bit) & bit) != 0u)
        return;
    const uint at = atomicAdd(unlisted.count, 1u);
    unlistedTiles[at] = tile;
    if (at % TILE_ROW == 0u)
        atomicAdd(unlisted.groupsY, 1u);
}

#endif
