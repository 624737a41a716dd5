// SPDX-License-Identifier: Apache-2.0
// Makes clusters of surface samples: one per 8x8 pixel tile. A deep tile has one cluster per slice of
// its depth instead, which split_tiles makes. A tile without a surface is on no list and costs nothing
// later; every other tile is put on the work list of its class.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernels/common/cluster_bounds.glsl"
#include "kernels/common/tile_class.glsl"

layout(local_size_x = TILE_CLUSTERS_GROUP) in;
layout(scalar, binding = TILE_CLUSTERS_TILES) writeonly buffer Tiles
{
    TileClusters tiles[];
};
layout(scalar, binding = TILE_CLUSTERS_SURFACES) buffer Surfaces
{
    WorkList surfaces[TILE_CLASSES];
    uint surfaceTiles[];
};
layout(scalar, binding = TILE_CLUSTERS_SPLITS) buffer Splits
{
    WorkList splits, slices; // slices: arguments of cluster_lists alone
    uint splitTiles[];
};

void main()
{
    const uint tile = gl_GlobalInvocationID.x;
    if (tile >= params.tileCount)
        return;
    const uvec2 first = firstPixelOfTile(tile, frameParams.size.x);
    const uvec2 end = min(first + TILE_SIZE, frameParams.size);
    // First the range of depth alone: if there is no surface, the loop over samples ends at once.
    uint lowest = 0xFFFFFFFFu, highest = 0u;
    for (uint y = first.y; y < end.y; ++y)
        for (uint x = first.x; x < end.x; ++x) {
            const float depth = depthAt(uvec2(x, y));
            if (depth != frameParams.clearDepth) {
                lowest = min(lowest, depthBits(depth));
                highest = max(highest, depthBits(depth));
            }
        }
    const bool empty = lowest > highest;
    Cluster cluster = emptyCluster(tile);
    for (uint y = first.y; y < end.y && !empty; ++y)
        for (uint x = first.x; x < end.x; ++x) {
            const float depth = depthAt(uvec2(x, y));
            if (depth != frameParams.clearDepth)
                addSample(cluster, uvec2(x, y), depth);
        }
    if (empty) {
        tiles[tile] = TileClusters(0u, 1u, 0u, UNSPLIT, 0u);
        return;
    }
    const uint tileClass = classOfSurfaces(first, end);
    const uint surface = atomicAdd(surfaces[tileClass].count, 1u);
    if (surface % TILE_ROW == 0u)
        atomicAdd(surfaces[tileClass].groupsY, 1u);
    surfaceTiles[surfaces[tileClass].first + surface] = tile;

    const bool deep = distance(cluster.min, cluster.max) > params.splitLength &&
                      highest - lowest >= SLICES;
    const uint split = deep ? atomicAdd(splits.count, 1u) : params.splitCapacity;
    if (split < params.splitCapacity) {
        const uint perGroup = SPLIT_TILES_GROUP / SLICES;
        if (split % (SPLIT_ROW * perGroup) == 0u)
            atomicAdd(splits.groupsY, 1u);
        if (split % (SLICE_ROW / SLICES) == 0u)
            atomicAdd(slices.groupsY, 1u);
        splitTiles[split] = tile;
        const uint shift = uint(findMSB(highest - lowest) + 1 - int(SLICE_BITS));
        tiles[tile] =
            TileClusters(params.firstSplit + split * SLICES, lowest, highest, shift,
                         tileClass << CLASS_BITS);
    } else {
        tiles[tile] =
            TileClusters(tile, lowest, highest, UNSPLIT, tileClass << CLASS_BITS);
        clusters[tile] = withMargins(cluster, frameParams.projection);
    }
}
