// SPDX-License-Identifier: Apache-2.0
// Makes the clusters of deep tiles: one per slice of depth. One lane per slice, so that the lanes of a
// tile walk its pixels in step.
#version 460
#extension GL_GOOGLE_include_directive : require
#define GBUFFER_NORMALS_ONLY
#include "kernels/common/cluster_bounds.glsl"

layout(local_size_x = SPLIT_TILES_GROUP) in;
layout(scalar, binding = TILE_CLUSTERS_TILES) readonly buffer Tiles
{
    TileClusters tiles[];
};
layout(scalar, binding = TILE_CLUSTERS_SPLITS) readonly buffer Splits
{
    WorkList splits, slices;
    uint splitTiles[];
};

void main()
{
    const uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    const uint lane = group * SPLIT_TILES_GROUP + gl_LocalInvocationIndex;
    const uint split = lane / SLICES, slice = lane % SLICES;
    if (split >= min(splits.count, params.splitCapacity))
        return;
    const uint tile = splitTiles[split];
    const TileClusters at = tiles[tile];
    const uvec2 first = firstPixelOfTile(tile, frameParams.size.x);
    const uvec2 end = min(first + TILE_SIZE, frameParams.size);
    Cluster cluster = emptyCluster(tile);
    for (uint y = first.y; y < end.y; ++y)
        for (uint x = first.x; x < end.x; ++x) {
            const float depth = depthAt(uvec2(x, y));
            const bool here = (depthBits(depth) - at.lowest) >> at.shift == slice;
            if (depth != frameParams.clearDepth && here)
                addSample(cluster, uvec2(x, y), depth);
        }
    clusters[at.first + slice] = withMargins(cluster, frameParams.projection);
}
