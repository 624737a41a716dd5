// SPDX-License-Identifier: Apache-2.0
// What tile_clusters writes of a tile: its record, its cluster, and its place on a work list. A tile
// without a surface is on no list and costs nothing later; every other tile is put on the work list of
// its class, which tells whether none of its surfaces has a specular lobe.
#ifndef CND_COMMON_TILE_RECORD
#define CND_COMMON_TILE_RECORD

#include "kernels/common/cluster_bounds.glsl"
#include "shared/lighting_data.h"

layout(constant_id = SPEC_FINDS_DIFFUSE) const bool findsDiffuse = false;
layout(scalar, binding = TILE_CLUSTERS_TILES) writeonly buffer Tiles
{
    TileClusters tiles[];
};
layout(scalar, binding = TILE_CLUSTERS_SURFACES) buffer Surfaces
{
    WorkList surfaces[TILE_WORK_LISTS];
    uint surfaceTiles[];
};
layout(scalar, binding = TILE_CLUSTERS_SPLITS) buffer Splits
{
    WorkList splits, slices; // slices: arguments of cluster_lists alone
    uint splitTiles[];
};

// Tells whether the surface of a pixel has no specular lobe. A NaN is not 0, so a surface with a NaN
// has the lobe.
bool isDiffuse(uvec2 pixel)
{
    const Surface s = readSurface(pixel);
    return s.F0.x == 0.0 && s.F0.y == 0.0 && s.F0.z == 0.0 && s.specularWeight == 0.0;
}

uint classOf(bool diffuse)
{
    return diffuse ? CLASS_DIFFUSE : CLASS_ANY;
}

// Puts a tile with surfaces on the work list of its class.
void appendSurface(uint tile, uint tileClass)
{
    const uint surface = atomicAdd(surfaces[tileClass].count, 1u);
    if (surface % TILE_ROW == 0u)
        atomicAdd(surfaces[tileClass].groupsY, 1u);
    surfaceTiles[surfaces[tileClass].first + surface] = tile;
}

// Takes room for the slices of a tile if it is deep, and puts it on the list of split tiles. Returns
// the place in that list; from params.splitCapacity on, the tile stays one cluster.
uint takeSplit(uint tile, Cluster cluster, uint lowest, uint highest)
{
    const bool deep = distance(cluster.min, cluster.max) > params.splitLength &&
                      highest - lowest >= SLICES;
    const uint split = deep ? atomicAdd(splits.count, 1u) : params.splitCapacity;
    if (split < params.splitCapacity) {
        if (split % SPLIT_ROW == 0u) {
            atomicAdd(splits.groupsY, 1u);
            atomicAdd(slices.groupsY, 1u);
        }
        splitTiles[split] = tile;
    }
    return split;
}

// Writes what is known of a tile, and its cluster unless the tile is deep. One lane calls it.
void writeTile(FrameParams frame, uint tile, Cluster cluster, uint highest, uint tileClass)
{
    const uint lowest = cluster.depthBits;
    if (isEmpty(cluster)) {
        tiles[tile] = TileClusters(0u, 1u, 0u, UNSPLIT, 0u);
        return;
    }
    appendSurface(tile, tileClass);
    const uint split = takeSplit(tile, cluster, lowest, highest);
    if (split < params.splitCapacity) {
        const uint shift = uint(findMSB(highest - lowest) + 1 - int(SLICE_BITS));
        tiles[tile] = TileClusters(params.firstSplit + split * SLICES, lowest, highest, shift,
                                   tileClass << CLASS_BITS);
    } else {
        tiles[tile] = TileClusters(tile, lowest, highest, UNSPLIT, tileClass << CLASS_BITS);
        clusters[tile] = withMargins(cluster, frame.projection);
    }
}

#endif
