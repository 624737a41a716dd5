// SPDX-License-Identifier: Apache-2.0
// Makes the clusters of blocks of tiles: one per slice of a block's depth. How
// many slices a block has depends on its length: the slices of a short block share most of their
// lights, so their lists take longer to make than they save (DECISIONS 71). On GPUs the lanes of a
// group make the slices of one block, and each lane takes a few clusters of the children. On llvmpipe
// each lane makes one slice, and the lanes of a block walk its children in step. Both make the same
// clusters.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/cluster_margins.glsl"
#define FRAME_PARAMS BLOCK_CLUSTERS_FRAME
#include "kernels/common/frame_params.glsl"
#include "lib/ordered_bits.glsl"
#include "lib/projection.glsl"

layout(local_size_x = BLOCK_CLUSTERS_GROUP) in;
layout(constant_id = SPEC_LANES_TOGETHER) const bool lanesTogether = true;
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

const uint CHILDREN = BLOCK_SIDE * BLOCK_SIDE;

// The range of depth bits of a block, and the sum of the view rays of its children in their order.
struct BlockRange {
    uint lowest, highest;
    vec3 rays;
};

// Sets the i-th child of a block. Returns false outside the image and if the child has no samples.
bool takeChild(uint block, uint i, out TileClusters child)
{
    const uvec2 at = BLOCK_SIDE * uvec2(block % params.blockCountX, block / params.blockCountX) +
                     uvec2(i % BLOCK_SIDE, i / BLOCK_SIDE);
    const uvec2 inside = min(at, uvec2(params.tileCountX, params.tileCountY) - 1u);
    child = tiles[inside.y * params.tileCountX + inside.x];
    return inside == at && child.lowest <= child.highest;
}

// Returns how many clusters a child with samples has.
uint clusterCount(TileClusters child)
{
    return min((child.highest - child.lowest) >> child.shift, BLOCK_SLICES - 1u) + 1u;
}

// Returns the binary logarithm of the number of slices of a block that has samples. The block's length
// is that of its samples along the z axis of view space, and its width is that of its pixels at the
// sample nearest to the camera. A block that is no longer than wide is one slice; one that is up to
// two or four times as long has two or four, and a longer one has eight.
int sliceBitsOf(BlockRange range)
{
    const Projection m = frameParams.projection;
    const float lowest = viewZ(m, uintBitsToFloat(range.lowest));
    const float highest = viewZ(m, uintBitsToFloat(range.highest));
    const float w = min(abs(m.m23 * lowest + m.m33), abs(m.m23 * highest + m.m33));
    const float side = float(TILE_SIZE * BLOCK_SIDE);
    const float width = 2.0 * side * frameParams.invImageSize.x * w / abs(m.m00);
    const float blockLength = abs(lowest - highest);
    return blockLength > 4.0 * width ? 3 : blockLength > 2.0 * width ? 2 : blockLength > width ? 1 : 0;
}

// Returns the record of a block.
TileClusters recordOf(uint block, BlockRange range)
{
    const bool empty = range.lowest > range.highest;
    int shift = 0;
    if (!empty)
        shift = max(findMSB(range.highest - range.lowest) + 1 - sliceBitsOf(range), 0);
    return TileClusters(params.clusterFirst + block * BLOCK_SLICES, range.lowest, range.highest,
                        uint(shift), 0u);
}

vec3 rayOf(BlockRange range)
{
    return range.rays == vec3(0.0) ? range.rays : normalize(range.rays);
}

// Returns the slope of a cone around `ray` that holds the cone of a child's cluster. A cluster without
// a cone has no ray, so the distance is 1 and the result is MAX_SLOPE.
float slopeAround(vec3 ray, uint cluster)
{
    return widerSlope(clusters[cluster].slope, distance(ray, clusters[cluster].ray) + DOT_MARGIN);
}

Cluster emptySlice(vec3 ray)
{
    return Cluster(vec3(UNBOUNDED), 0u, vec3(-UNBOUNDED), 0u, vec3(0.0), -UNBOUNDED, UNBOUNDED, 0.0,
                   0xFFFFFFFFu, ray, 0.0);
}

// One lane makes the cluster of a slice.
void makeByLane(uint block, uint slice)
{
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
void makeByGroup(uint block)
{
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

void main()
{
    const uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    const uint lane = group * BLOCK_CLUSTERS_GROUP + gl_LocalInvocationIndex;
    const uint block = lanesTogether ? group : lane / BLOCK_SLICES;
    if (block >= params.blockCount)
        return;
    if (lanesTogether)
        makeByGroup(block);
    else
        makeByLane(block, lane % BLOCK_SLICES);
}
