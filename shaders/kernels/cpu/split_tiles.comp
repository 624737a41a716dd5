// SPDX-License-Identifier: Apache-2.0
// The form of split_tiles for llvmpipe: one lane makes all slices of a tile.
#version 460
#extension GL_GOOGLE_include_directive : require
#define GBUFFER_NORMALS_ONLY
#include "kernels/cpu/pixels_of_tile.glsl"

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

// Adds a sample to a slice if it is `here`.
void addToSlice(inout Cluster slice, bool here, Sample s)
{
    if (here)
        addSampleInOrder(slice, s);
}

// One lane makes all slices of a tile.
void main()
{
    const uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    const uint split = group * SPLIT_TILES_GROUP + gl_LocalInvocationIndex;
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
