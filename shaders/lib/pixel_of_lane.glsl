// SPDX-License-Identifier: Apache-2.0
// Pixels of a tile in blocks of 4x2, and those in blocks of 8x4: lanes that run together are close in
// both directions, so their lights differ less than along a row.
#ifndef CND_LIB_PIXEL_OF_LANE
#define CND_LIB_PIXEL_OF_LANE

// The pixel within the tile, for lanes 0 .. TILE_SIZE^2 - 1.
uvec2 pixelOfLane(uint lane)
{
    return uvec2(bitfieldInsert(lane & 3u, lane >> 3u, 2, 1),
                 bitfieldInsert(lane >> 2u & 1u, lane >> 4u, 1, 2));
}

#endif
