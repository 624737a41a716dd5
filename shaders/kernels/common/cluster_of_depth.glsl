// SPDX-License-Identifier: Apache-2.0
// The cluster of a sample. The includer has tiles[], the TileClusters.
#ifndef CND_COMMON_CLUSTER_OF_DEPTH
#define CND_COMMON_CLUSTER_OF_DEPTH

#include "lib/projection.glsl"

// Returns the cluster of a sample of a tile with this depth.
uint clusterOf(uint tile, float depth)
{
    return tiles[tile].first + ((depthBits(depth) - tiles[tile].lowest) >> tiles[tile].shift);
}

#endif
