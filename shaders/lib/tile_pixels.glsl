// SPDX-License-Identifier: Apache-2.0
// The pixels of a tile of TILE_SIZE x TILE_SIZE pixels, and the lanes that take them.
#ifndef CND_LIB_TILE_PIXELS
#define CND_LIB_TILE_PIXELS

#include "shared/lighting_data.h"

// Returns the first pixel of a tile. Tiles are numbered row by row; the last tile of a row may reach
// beyond the image.
uvec2 firstPixelOfTile(uint tile, uint imageWidth)
{
    const uint tilesInRow = (imageWidth + TILE_SIZE - 1u) / TILE_SIZE;
    return TILE_SIZE * uvec2(tile % tilesInRow, tile / tilesInRow);
}

// Returns the pixel within the tile, for lanes 0 .. TILE_SIZE^2 - 1, in blocks of 8x4 pixels, made of
// blocks of 4x2. Lanes that run together are so close in both directions that their lights differ less
// than those of pixels along a row.
uvec2 pixelOfLane(uint lane)
{
    return uvec2(bitfieldInsert(lane & 3u, lane >> 3u, 2, 1),
                 bitfieldInsert(lane >> 2u & 1u, lane >> 4u, 1, 2));
}

#endif
