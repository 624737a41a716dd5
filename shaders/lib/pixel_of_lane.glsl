// SPDX-License-Identifier: Apache-2.0
// The order of a tile's pixels: blocks of 8x4 pixels, made of blocks of 4x2. Lanes that run together
// are so close in both directions that their lights differ less than those of pixels along a row.
#ifndef CND_LIB_PIXEL_OF_LANE
#define CND_LIB_PIXEL_OF_LANE

// Returns the pixel within the tile, for lanes 0 .. TILE_SIZE^2 - 1.
uvec2 pixelOfLane(uint lane)
{
    return uvec2(bitfieldInsert(lane & 3u, lane >> 3u, 2, 1),
                 bitfieldInsert(lane >> 2u & 1u, lane >> 4u, 1, 2));
}

#endif
