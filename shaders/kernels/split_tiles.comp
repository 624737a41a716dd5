// SPDX-License-Identifier: Apache-2.0
// Makes the clusters of deep tiles: one per slice of depth. Several lanes make a slice, each from a row
// of the tile's pixels.
#version 460
#extension GL_GOOGLE_include_directive : require
#define GBUFFER_NORMALS_ONLY
#include "kernels/common/cluster_bounds.glsl"

layout(local_size_x = SPLIT_TILES_GROUP) in;
#include "kernels/common/bounds_of_rows.glsl"
layout(scalar, binding = TILE_CLUSTERS_TILES) readonly buffer Tiles
{
    TileClusters tiles[];
};
layout(scalar, binding = TILE_CLUSTERS_SPLITS) readonly buffer Splits
{
    WorkList splits, slices;
    uint splitTiles[];
};

// Sets the tile and the slice of the i-th item of work. Returns false after the last.
bool takeSlice(uint i, out uint tile, out uint slice)
{
    const uint count = min(splits.count, params.splitCapacity) * SLICES;
    tile = i < count ? splitTiles[i / SLICES] : 0u;
    slice = i % SLICES;
    return i < count;
}

// The lanes of a group make several slices. Every lane takes part in the barriers.
void main()
{
    const uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
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
