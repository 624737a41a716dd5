// SPDX-License-Identifier: Apache-2.0
// Pixels of a tile in blocks of 4x2, and those in blocks of 8x4: lanes that run together are close in
// both directions, so their lights differ less than along a row.
#ifndef CND_LIB_PIXEL_OF_LANE
#define CND_LIB_PIXEL_OF_LANE

// Of TILE_SIZE^2 lanes, the pixel within the tile.
uvec2 pixelOfLane()
{
    const uint i = gl_LocalInvocationIndex;
    return uvec2(bitfieldInsert(i & 3u, i >> 3u, 2, 1), bitfieldInsert(i >> 2u & 1u, i >> 4u, 1, 2));
}

#endif
