// SPDX-License-Identifier: Apache-2.0
// The work lists of shade_unlisted. The includer provides unlisted[], unlistedTiles[], counters, and
// what tile_work_lists.glsl asks for.
#include "kernels/common/tile_work_lists.glsl"

// Appends a tile to the work lists of shade_unlisted, and counts the cluster.
void appendUnlisted(uint tile)
{
    atomicAdd(counters.unlistedClusters, 1u);
    APPEND_TILE(unlisted, unlistedTiles, tile, UNLISTED_BITS, ANY_HEIGHT)
}
