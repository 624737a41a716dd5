// SPDX-License-Identifier: Apache-2.0
// Makes clusters of surface samples: one per 8x8 pixel tile. A deep tile has one cluster per slice of
// its depth instead, which split_tiles makes. A tile without a surface is on no list and costs nothing
// later; every other tile is put on the work list of its class. On GPUs several lanes make the cluster
// of a tile, each from a row of its pixels. On llvmpipe one lane makes it. Both make the same cluster.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernels/common/cluster_bounds.glsl"
#include "kernels/common/tile_class.glsl"
#define GROUP_LANES TILE_CLUSTERS_GROUP
#include "kernels/common/bounds_of_rows.glsl"

layout(local_size_x = TILE_CLUSTERS_GROUP) in;
layout(constant_id = SPEC_LANES_TOGETHER) const bool lanesTogether = true;
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

// One lane makes the cluster of a tile.
void makeByLane(FrameParams frame, uint tile)
{
    if (tile >= params.tileCount)
        return;
    const uvec2 first = firstPixelOfTile(tile, frame.size.x), last = frame.size - 1u;
    const uint pixels = TILE_SIZE * TILE_SIZE;
    // Looks for the first surface, so that tiles without one take a fraction of the time: llvmpipe runs
    // the body of an `if` even if no lane needs it, but leaves a loop when no lane is left in it.
    uint i = 0u;
    bool empty = true;
    do {
        if (empty) // SwiftShader needs the condition in the body too (DECISIONS 42)
            empty = depthAt(pixelOfTile(first, last, i)) == frame.clearDepth;
        ++i;
    } while (empty && i < pixels);
    --i; // back to that surface, or to the last pixel
    uint highest = 0u;
    Cluster cluster = emptyCluster(frame, tile);
    do {
        const uvec2 pixel = pixelOfTile(first, last, i);
        const float depth = depthAt(pixel);
        if (depth != frame.clearDepth) {
            highest = max(highest, depthBits(depth));
            addSampleInOrder(cluster, readSample(frame, pixel, depth));
        }
        ++i;
    } while (i < pixels);
    uint tileClass = CLASS_ANY;
    if (!empty)
        tileClass = classOfTile(first, min(first + TILE_SIZE, frame.size));
    writeTile(frame, tile, cluster, highest, tileClass);
}

shared uint diffuseTiles[CLUSTERS_OF_GROUP]; // 1: no surface has a specular lobe

// Finds the classes of the tiles. All lanes of the group must call it.
void findClassesByRows(FrameParams frame, SamplesOfTile samples)
{
    diffuseTiles[clusterOfLane()] = 1u;
    barrier();
    bool diffuse = true;
    for (uint x = 0u; x < TILE_SIZE && diffuse; ++x) {
        uvec2 pixel;
        float depth;
        if (takeSample(frame, samples, x, pixel, depth))
            diffuse = isDiffuse(pixel);
    }
    atomicAnd(diffuseTiles[clusterOfLane()], diffuse ? 1u : 0u);
    barrier();
}

// The lanes of a group make the clusters of several tiles. Every lane takes part in the barriers.
void makeByRows(FrameParams frame, uint group)
{
    const uint tileOfRow = group * CLUSTERS_OF_GROUP + clusterOfLane();
    const SamplesOfTile samples = SamplesOfTile(firstPixelOfTile(tileOfRow, frame.size.x),
                                                tileOfRow < params.tileCount, 0u, UNSPLIT, 0u);
    findBoundsByRows(frame, tileOfRow, samples);
    if (findsDiffuse)
        findClassesByRows(frame, samples);
    const uint lane = gl_LocalInvocationIndex, tile = group * CLUSTERS_OF_GROUP + lane;
    if (lane >= CLUSTERS_OF_GROUP || tile >= params.tileCount)
        return;
    uint highest;
    const Cluster cluster = boundsFound(frame, tile, lane, highest);
    writeTile(frame, tile, cluster, highest, classOf(findsDiffuse && diffuseTiles[lane] != 0u));
}

void main()
{
    const uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    const FrameParams frame = frameParams;
    if (lanesTogether)
        makeByRows(frame, group);
    else
        makeByLane(frame, group * TILE_CLUSTERS_GROUP + gl_LocalInvocationIndex);
}
