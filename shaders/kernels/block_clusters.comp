// SPDX-License-Identifier: Apache-2.0
// Makes the clusters of blocks of tiles, or of blocks of blocks: one per slice of a block's depth. One
// lane per slice, so that the lanes of a block walk its children in step.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/cluster_margins.glsl"

layout(local_size_x = BLOCK_CLUSTERS_GROUP) in;
layout(push_constant, scalar) uniform Push
{
    BlockClustersParams params;
};
layout(scalar, binding = BLOCK_CLUSTERS_CLUSTERS) buffer Clusters
{
    Cluster clusters[];
};
layout(scalar, binding = BLOCK_CLUSTERS_TILES) buffer Tiles
{
    TileClusters tiles[];
};

// Returns the slope of a cone around `ray` that holds a child's cone. A child without a cone has no
// ray, so the distance is 1 and the result is MAX_SLOPE.
float slopeAround(vec3 ray, Cluster child)
{
    return widerSlope(child.slope, distance(ray, child.ray) + DOT_MARGIN);
}

void main()
{
    const uint lane = gl_GlobalInvocationID.x;
    const uint block = lane / BLOCK_SLICES, slice = lane % BLOCK_SLICES;
    if (block >= params.blockCount)
        return;
    const uvec2 first =
        BLOCK_SIDE * uvec2(block % params.blockCountX, block / params.blockCountX);
    const uvec2 end = min(first + BLOCK_SIDE, uvec2(params.childCountX, params.childCountY));
    uint lowest = 0xFFFFFFFFu, highest = 0u;
    vec3 rays = vec3(0.0);
    for (uint y = first.y; y < end.y; ++y)
        for (uint x = first.x; x < end.x; ++x) {
            const TileClusters child = tiles[params.childFirst + y * params.childCountX + x];
            if (child.lowest <= child.highest) {
                lowest = min(lowest, child.lowest);
                highest = max(highest, child.highest);
                rays += clusters[child.first].ray;
            }
        }
    const uint firstSlice = params.clusterFirst + block * BLOCK_SLICES;
    const bool empty = lowest > highest;
    const uint shift = empty ? 0u : uint(max(findMSB(highest - lowest) + 1 - int(BLOCK_SLICE_BITS), 0));
    if (slice == 0u)
        tiles[params.blockFirst + block] = TileClusters(firstSlice, lowest, highest, shift, 0u);

    rays = rays == vec3(0.0) ? rays : normalize(rays);
    Cluster merged = Cluster(vec3(UNBOUNDED), 0u, vec3(-UNBOUNDED), 0u, vec3(0.0), -UNBOUNDED,
                             UNBOUNDED, 0.0, 0xFFFFFFFFu, rays, 0.0);
    for (uint y = first.y; y < end.y && !empty; ++y)
        for (uint x = first.x; x < end.x; ++x) {
            const TileClusters child = tiles[params.childFirst + y * params.childCountX + x];
            const uint count =
                child.lowest > child.highest
                    ? 0u
                    : min((child.highest - child.lowest) >> child.shift, BLOCK_SLICES - 1u) + 1u;
            for (uint k = 0u; k < count; ++k) {
                const uint at = child.first + k;
                const uint bits = clusters[at].depthBits;
                // A cluster without samples has the largest number as its bits, and is left out.
                if (bits <= highest && (bits - lowest) >> shift == slice) {
                    merged.min = min(merged.min, clusters[at].min);
                    merged.max = max(merged.max, clusters[at].max);
                    merged.depthBits = min(merged.depthBits, bits);
                    merged.slope = max(merged.slope, slopeAround(merged.ray, clusters[at]));
                    clusters[at].parent = firstSlice + slice;
                }
            }
        }
    clusters[firstSlice + slice] = merged.slope < MAX_SLOPE ? merged : withoutCone(merged);
}
