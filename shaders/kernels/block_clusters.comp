// SPDX-License-Identifier: Apache-2.0
// Makes the clusters of blocks of tiles: one per slice of a block's depth. The lanes of a group make
// the slices of one block, and each lane takes a few clusters of the children.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernels/common/block_range.glsl"
#include "lib/ordered_bits.glsl"

layout(local_size_x = BLOCK_CLUSTERS_GROUP) in;

// What the lanes of a group have found of the slices of their block: the lowest of each value as
// ordered bits. The highest x is the lowest of -x.
const uint LEAST_MIN = 0u;       // 3 words
const uint LEAST_MINUS_MAX = 3u; // 3 words
const uint LEAST_DEPTH = 6u;
const uint LEAST_MINUS_SLOPE = 7u;
const uint LEAST_COUNT = 8u;
shared uint least[BLOCK_SLICES * LEAST_COUNT];
shared TileClusters children[CHILDREN];
shared uint clusterCounts[CHILDREN];
shared vec3 rays[CHILDREN];

void findLeast(uint what, float value)
{
    atomicMin(least[what], orderedBits(value));
}

// Adds a cluster of a child to the slice that it belongs to.
void addToSlice(uint cluster, TileClusters record, vec3 ray)
{
    const uint bits = clusters[cluster].depthBits;
    // A cluster without samples has the largest number as its bits, and is left out.
    if (bits > record.highest)
        return;
    const uint slice = (bits - record.lowest) >> record.shift;
    const uint first = slice * LEAST_COUNT;
    for (uint axis = 0u; axis < 3u; ++axis) {
        findLeast(first + LEAST_MIN + axis, clusters[cluster].min[axis]);
        findLeast(first + LEAST_MINUS_MAX + axis, -clusters[cluster].max[axis]);
    }
    atomicMin(least[first + LEAST_DEPTH], bits);
    findLeast(first + LEAST_MINUS_SLOPE, -slopeAround(ray, cluster));
    clusters[cluster].parent = record.first + slice;
}

// Returns a slice of the block from what the lanes have found.
Cluster foundSlice(uint slice, vec3 ray)
{
    Cluster merged = emptySlice(ray);
    const uint first = slice * LEAST_COUNT;
    merged.depthBits = least[first + LEAST_DEPTH];
    if (merged.depthBits == 0xFFFFFFFFu)
        return merged;
    for (uint axis = 0u; axis < 3u; ++axis) {
        merged.min[axis] = floatOfOrdered(least[first + LEAST_MIN + axis]);
        merged.max[axis] = -floatOfOrdered(least[first + LEAST_MINUS_MAX + axis]);
    }
    merged.slope = -floatOfOrdered(least[first + LEAST_MINUS_SLOPE]);
    return merged;
}

// The lanes of a group make the clusters of all slices of a block.
void main()
{
    const uint block = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    if (block >= params.blockCount)
        return;
    const uint lane = gl_LocalInvocationIndex;
    TileClusters child;
    if (lane < CHILDREN) {
        const bool here = takeChild(block, lane, child);
        rays[lane] = here ? clusters[child.first].ray : vec3(0.0);
        children[lane] = child;
        clusterCounts[lane] = here ? clusterCount(child) : 0u;
    }
    for (uint i = lane; i < BLOCK_SLICES * LEAST_COUNT; i += BLOCK_CLUSTERS_GROUP)
        least[i] = 0xFFFFFFFFu;
    barrier();
    BlockRange range = BlockRange(0xFFFFFFFFu, 0u, vec3(0.0));
    for (uint i = 0u; i < CHILDREN; ++i)
        if (clusterCounts[i] != 0u) {
            range.lowest = min(range.lowest, children[i].lowest);
            range.highest = max(range.highest, children[i].highest);
            range.rays += rays[i];
        }
    const TileClusters record = recordOf(block, range);
    if (lane == 0u)
        tiles[params.blockFirst + block] = record;
    const vec3 ray = rayOf(range);
    for (uint i = lane; i < CHILDREN * BLOCK_SLICES; i += BLOCK_CLUSTERS_GROUP) {
        const uint from = i / BLOCK_SLICES, k = i % BLOCK_SLICES;
        if (k < clusterCounts[from])
            addToSlice(children[from].first + k, record, ray);
    }
    barrier();
    if (lane >= BLOCK_SLICES)
        return;
    const Cluster merged = foundSlice(lane, ray);
    clusters[record.first + lane] = merged.slope < MAX_SLOPE ? merged : withoutCone(merged);
}
