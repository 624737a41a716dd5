// SPDX-License-Identifier: Apache-2.0
// The form of tile_clusters for llvmpipe: one lane makes the cluster of a tile.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernels/common/tile_record.glsl"
#include "kernels/cpu/pixels_of_tile.glsl"

layout(local_size_x = TILE_CLUSTERS_GROUP) in;

// Returns the class of the tile with the pixels first .. end - 1. The loop ends at the first surface
// with a specular lobe.
uint classOfTile(uvec2 first, uvec2 end)
{
    bool diffuse = findsDiffuse;
    for (uint y = first.y; y < end.y && diffuse; ++y)
        for (uint x = first.x; x < end.x && diffuse; ++x)
            if (depthAt(uvec2(x, y)) != frameParams.clearDepth)
                diffuse = isDiffuse(uvec2(x, y));
    return classOf(diffuse);
}

// One lane makes the cluster of a tile.
void main()
{
    const uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    const uint tile = group * TILE_CLUSTERS_GROUP + gl_LocalInvocationIndex;
    const FrameParams frame = frameParams;
    if (tile >= params.tileCount)
        return;
    const uvec2 first = firstPixelOfTile(tile, frame.size.x), last = frame.size - 1u;
    const uint pixels = TILE_SIZE * TILE_SIZE;
    // Looks for the first surface, so that tiles without one take a fraction of the time: llvmpipe runs
    // the body of an `if` even if no lane needs it, but leaves a loop when no lane is left in it.
    uint i = 0u;
    bool empty = true;
    do {
        if (empty) // SwiftShader, which runs this form in tests, needs it here too (IF_COUNTS_DIFFER)
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
