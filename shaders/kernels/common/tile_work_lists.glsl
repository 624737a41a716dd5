// SPDX-License-Identifier: Apache-2.0
// Work lists of tiles. The includer provides tiles[], and params with the light type.
#ifndef CND_COMMON_TILE_WORK_LISTS
#define CND_COMMON_TILE_WORK_LISTS

// Appends a tile to a work list unless another cluster's lane has done so for this light type.
// `height`: that of the tile, such as ANY_HEIGHT.
#define APPEND_TILE(works, workTiles, tile, firstBit, height)                                      \
    const uint bit = 1u << ((firstBit) + params.lightType);                                        \
    const uint before = atomicOr(tiles[tile].onLists, bit);                                        \
    const uint work = (height) * TILE_CLASSES + (before >> CLASS_BITS);                            \
    if ((before & bit) == 0u) {                                                                    \
        const uint place = atomicAdd(works[work].count, 1u);                                       \
        workTiles[works[work].first + place] = tile;                                               \
        if (place % TILE_ROW == 0u)                                                                \
            atomicAdd(works[work].groupsY, 1u);                                                    \
    }

#endif
