// SPDX-License-Identifier: Apache-2.0
// The range of a block of tiles, and the record that follows from it. A block has one cluster per slice
// of its depth. How many slices it has depends on its length: the slices of a short block share most of
// their lights, so their lists take longer to make than they save (DECISIONS 71).
#ifndef CND_COMMON_BLOCK_RANGE
#define CND_COMMON_BLOCK_RANGE

#include "lib/cluster_margins.glsl"
#include "lib/projection.glsl"
#include "shared/cluster_data.h"
#include "kernels/common/frame_params.glsl"

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

#endif
