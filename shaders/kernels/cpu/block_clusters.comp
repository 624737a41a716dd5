// SPDX-License-Identifier: Apache-2.0
// The form of block_clusters for llvmpipe: one lane makes one slice.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernels/common/block_range.glsl"

layout(local_size_x = BLOCK_CLUSTERS_GROUP) in;

// One lane makes the cluster of a slice, and the lanes of a block walk its children in step.
void main()
{
    const uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    const uint lane = group * BLOCK_CLUSTERS_GROUP + gl_LocalInvocationIndex;
    const uint block = lane / BLOCK_SLICES, slice = lane % BLOCK_SLICES;
    if (block >= params.blockCount)
        return;
    BlockRange range = BlockRange(0xFFFFFFFFu, 0u, vec3(0.0));
    TileClusters child;
    uint i = 0u;
    do {
        if (takeChild(block, i, child)) {
            range.lowest = min(range.lowest, child.lowest);
            range.highest = max(range.highest, child.highest);
            range.rays += clusters[child.first].ray;
        }
        ++i;
    } while (i < CHILDREN);
    const TileClusters record = recordOf(block, range);
    if (slice == 0u)
        tiles[params.blockFirst + block] = record;
    const uint self = record.first + slice;
    Cluster merged = emptySlice(rayOf(range));
    if (range.lowest > range.highest) {
        clusters[self] = merged;
        return;
    }
    i = 0u;
    do {
        const uint count = takeChild(block, i, child) ? clusterCount(child) : 0u;
        uint k = 0u;
        do {
            const uint at = child.first + k;
            const uint bits = k < count ? clusters[at].depthBits : 0xFFFFFFFFu;
            // A cluster without samples has the largest number as its bits, and is left out.
            if (bits <= range.highest && (bits - range.lowest) >> record.shift == slice) {
                merged.min = min(merged.min, clusters[at].min);
                merged.max = max(merged.max, clusters[at].max);
                merged.depthBits = min(merged.depthBits, bits);
                merged.slope = max(merged.slope, slopeAround(merged.ray, at));
                clusters[at].parent = self;
            }
            ++k;
        } while (k < count);
        ++i;
    } while (i < CHILDREN);
    clusters[self] = merged.slope < MAX_SLOPE ? merged : withoutCone(merged);
}
