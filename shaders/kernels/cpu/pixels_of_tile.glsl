// SPDX-License-Identifier: Apache-2.0
// The pixels of a tile in their order, for lanes that bound a tile by themselves.
#ifndef CND_CPU_PIXELS_OF_TILE
#define CND_CPU_PIXELS_OF_TILE

#include "kernels/common/cluster_bounds.glsl"

// Adds a sample to a cluster. The normal of the first sample becomes the axis.
void addSampleInOrder(inout Cluster c, Sample s)
{
    c.axis = isEmpty(c) ? s.normal : c.axis;
    addSample(c, s);
}

// Returns the i-th pixel of a tile, row by row. `last` is the last pixel of the tile that lies in the
// image. Pixels beyond it are replaced by pixels within, so that a tile always has TILE_SIZE^2, of
// which some may come twice.
uvec2 pixelOfTile(uvec2 first, uvec2 last, uint i)
{
    return min(first + uvec2(i % TILE_SIZE, i / TILE_SIZE), last);
}

#endif
