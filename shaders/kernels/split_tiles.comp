// SPDX-License-Identifier: Apache-2.0
// Makes the clusters of deep tiles: one per slice of depth. On GPUs several lanes make a slice, each
// from a row of the tile's pixels. On llvmpipe one lane makes all slices of a tile. Both make the same
// clusters.
#version 460
#extension GL_GOOGLE_include_directive : require
#define GBUFFER_NORMALS_ONLY
#include "kernels/common/cluster_bounds.glsl"

#define GROUP_LANES SPLIT_TILES_GROUP
#include "kernels/common/bounds_of_rows.glsl"

layout(local_size_x = SPLIT_TILES_GROUP) in;
layout(constant_id = SPEC_LANES_TOGETHER) const bool lanesTogether = true;
layout(scalar, binding = TILE_CLUSTERS_TILES) readonly buffer Tiles
{
    TileClusters tiles[];
};
layout(scalar, binding = TILE_CLUSTERS_SPLITS) readonly buffer Splits
{
    WorkList splits, slices;
    uint splitTiles[];
};

// Adds a sample to a slice if it is `here`.
void addToSlice(inout Cluster slice, bool here, Sample s)
{
    if (here)
        addSampleInOrder(slice, s);
}

// One lane makes all slices of a tile.
void makeByLane(uint split)
{
    if (split >= min(splits.count, params.splitCapacity))
        return;
    const uint tile = splitTiles[split];
    const TileClusters at = tiles[tile];
    const FrameParams frame = frameParams;
    const uvec2 first = firstPixelOfTile(tile, frame.size.x), last = frame.size - 1u;
    // The slices are four variables instead of an array, so that they stay in registers.
    Cluster slice0 = emptyCluster(frame, tile);
    Cluster slice1 = slice0, slice2 = slice0, slice3 = slice0;
    uint i = 0u;
    do {
        const uvec2 pixel = pixelOfTile(first, last, i);
        const float depth = depthAt(pixel);
        if (depth != frame.clearDepth) {
            const Sample s = readSample(frame, pixel, depth);
            const uint slice = (s.depthBits - at.lowest) >> at.shift;
            addToSlice(slice0, slice == 0u, s);
            addToSlice(slice1, slice == 1u, s);
            addToSlice(slice2, slice == 2u, s);
            addToSlice(slice3, slice == 3u, s);
        }
        ++i;
    } while (i < TILE_SIZE * TILE_SIZE);
    clusters[at.first] = withMargins(slice0, frame.projection);
    clusters[at.first + 1u] = withMargins(slice1, frame.projection);
    clusters[at.first + 2u] = withMargins(slice2, frame.projection);
    clusters[at.first + 3u] = withMargins(slice3, frame.projection);
}

// Sets the tile and the slice of the i-th item of work. Returns false after the last.
bool takeSlice(uint i, out uint tile, out uint slice)
{
    const uint count = min(splits.count, params.splitCapacity) * SLICES;
    tile = i < count ? splitTiles[i / SLICES] : 0u;
    slice = i % SLICES;
    return i < count;
}

// The lanes of a group make several slices. Every lane takes part in the barriers.
void makeByRows(uint group)
{
    const FrameParams frame = frameParams;
    uint tile, slice, highest;
    const bool exists = takeSlice(group * CLUSTERS_OF_GROUP + clusterOfLane(), tile, slice);
    findBoundsByRows(frame, tile,
                     SamplesOfTile(firstPixelOfTile(tile, frame.size.x), exists, tiles[tile].lowest,
                                   tiles[tile].shift, slice));
    const uint lane = gl_LocalInvocationIndex;
    if (lane >= CLUSTERS_OF_GROUP)
        return;
    if (!takeSlice(group * CLUSTERS_OF_GROUP + lane, tile, slice))
        return;
    const Cluster cluster = boundsFound(frame, tile, lane, highest);
    clusters[tiles[tile].first + slice] = withMargins(cluster, frame.projection);
}

void main()
{
    const uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    if (lanesTogether)
        makeByRows(group);
    else
        makeByLane(group * SPLIT_TILES_GROUP + gl_LocalInvocationIndex);
}
