// SPDX-License-Identifier: Apache-2.0
// Bounds of clusters made by several lanes: each takes a row of the tile's pixels. So the lanes walk
// eight pixels instead of 64, one after the other, and spend hardly more instructions in all. The rows
// are joined in shared memory. Minima and maxima do not depend on the order in which they are taken, so
// the bounds have the same bits as those that one lane makes. Include it after the layout of the group.
#ifndef CND_COMMON_BOUNDS_OF_ROWS
#define CND_COMMON_BOUNDS_OF_ROWS

#include "kernels/common/cluster_bounds.glsl"
#include "lib/ordered_bits.glsl"

const uint CLUSTERS_OF_GROUP = gl_WorkGroupSize.x / TILE_SIZE;

// The values of which the rows find the lowest. The highest z, for instance, is the lowest of -z.
const uint LEAST_PIXEL = 0u; // with a sample, counted row by row
const uint LEAST_DEPTH = 1u;
const uint LEAST_NOT_DEPTH = 2u;      // ~depth bits
const uint LEAST_POSITION = 3u;       // 3 words
const uint LEAST_MINUS_POSITION = 6u; // 3 words
const uint LEAST_ALONG = 9u;
const uint LEAST_MINUS_ALONG = 10u;
const uint LEAST_COSINE = 11u;
const uint LEAST_MINUS_SLOPE = 12u;
const uint LEAST_COUNT = 13u;
shared uint least[CLUSTERS_OF_GROUP * LEAST_COUNT];
shared vec3 axes[CLUSTERS_OF_GROUP];

// Return which cluster of the group this lane works on, and which row of its tile.
uint clusterOfLane()
{
    return gl_LocalInvocationIndex / TILE_SIZE;
}

uint rowOfLane()
{
    return gl_LocalInvocationIndex % TILE_SIZE;
}

void findLeast(uint what, uint value)
{
    atomicMin(least[clusterOfLane() * LEAST_COUNT + what], value);
}

void findLeast(uint what, float value)
{
    findLeast(what, orderedBits(clamp(value, -UNBOUNDED, UNBOUNDED)));
}

// The samples of a tile that a cluster holds.
struct SamplesOfTile {
    uvec2 first; // pixel of the tile
    bool exists; // false: there are no samples
    // The samples with (depth bits - lowest) >> shift == slice.
    uint lowest, shift, slice;
};

// Tells whether a pixel of this lane's row is a sample, and reads its depth.
bool takeSample(FrameParams frame, SamplesOfTile samples, uint x, out uvec2 pixel, out float depth)
{
    const uvec2 at = samples.first + uvec2(x, rowOfLane());
    pixel = min(at, frame.size - 1u);
    depth = depthAt(pixel);
    return samples.exists && pixel == at && depth != frame.clearDepth &&
           (depthBits(depth) - samples.lowest) >> samples.shift == samples.slice;
}

// Finds the first sample and the range of depth.
void findRange(FrameParams frame, SamplesOfTile samples)
{
    uint firstX = TILE_SIZE, lowest = 0xFFFFFFFFu, highest = 0u;
    for (uint x = 0u; x < TILE_SIZE; ++x) {
        uvec2 pixel;
        float depth;
        if (takeSample(frame, samples, x, pixel, depth)) {
            firstX = min(firstX, x);
            lowest = min(lowest, depthBits(depth));
            highest = max(highest, depthBits(depth));
        }
    }
    if (firstX == TILE_SIZE)
        return;
    findLeast(LEAST_PIXEL, rowOfLane() * TILE_SIZE + firstX);
    findLeast(LEAST_DEPTH, lowest);
    findLeast(LEAST_NOT_DEPTH, ~highest);
}

// Finds the bounds of the samples of this lane's row, and joins them with those of the other rows. `c`
// is empty, but has its axis and its view ray.
void findBounds(FrameParams frame, SamplesOfTile samples, Cluster c)
{
    for (uint x = 0u; x < TILE_SIZE; ++x) {
        uvec2 pixel;
        float depth;
        if (takeSample(frame, samples, x, pixel, depth))
            addSample(c, readSample(frame, pixel, depth));
    }
    if (isEmpty(c))
        return;
    for (uint k = 0u; k < 3u; ++k) {
        findLeast(LEAST_POSITION + k, c.min[k]);
        findLeast(LEAST_MINUS_POSITION + k, -c.max[k]);
    }
    findLeast(LEAST_ALONG, c.slabMin);
    findLeast(LEAST_MINUS_ALONG, -c.slabMax);
    findLeast(LEAST_COSINE, c.minCos);
    findLeast(LEAST_MINUS_SLOPE, -c.slope);
}

// Finds the bounds of one cluster by each TILE_SIZE lanes. All lanes of the group must call it.
void findBoundsByRows(FrameParams frame, uint tile, SamplesOfTile samples)
{
    for (uint i = gl_LocalInvocationIndex; i < CLUSTERS_OF_GROUP * LEAST_COUNT; i += gl_WorkGroupSize.x)
        least[i] = 0xFFFFFFFFu;
    barrier();
    findRange(frame, samples);
    barrier();
    const uint pixel = least[clusterOfLane() * LEAST_COUNT + LEAST_PIXEL];
    if (pixel != 0xFFFFFFFFu) {
        Cluster c = emptyCluster(frame, tile);
        c.axis = readNormal(samples.first + uvec2(pixel % TILE_SIZE, pixel / TILE_SIZE));
        if (rowOfLane() == 0u)
            axes[clusterOfLane()] = c.axis;
        findBounds(frame, samples, c);
    }
    barrier();
}

// Returns what has been found of a cluster of the group, and the highest depth bits. One lane does this
// for each cluster, so that all lanes that finish clusters are neighbours.
Cluster boundsFound(FrameParams frame, uint tile, uint cluster, out uint highest)
{
    Cluster c = emptyCluster(frame, tile);
    const uint first = cluster * LEAST_COUNT;
    highest = ~least[first + LEAST_NOT_DEPTH];
    if (least[first + LEAST_PIXEL] == 0xFFFFFFFFu)
        return c;
    c.axis = axes[cluster];
    c.depthBits = least[first + LEAST_DEPTH];
    for (uint k = 0u; k < 3u; ++k) {
        c.min[k] = floatOfOrdered(least[first + LEAST_POSITION + k]);
        c.max[k] = -floatOfOrdered(least[first + LEAST_MINUS_POSITION + k]);
    }
    c.slabMin = floatOfOrdered(least[first + LEAST_ALONG]);
    c.slabMax = -floatOfOrdered(least[first + LEAST_MINUS_ALONG]);
    c.minCos = floatOfOrdered(least[first + LEAST_COSINE]);
    c.slope = -floatOfOrdered(least[first + LEAST_MINUS_SLOPE]);
    return c;
}

#endif
