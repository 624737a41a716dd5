// SPDX-License-Identifier: Apache-2.0
// A part of a list that several groups share (shared/cluster_data.h): its blocks, and the sum over all
// parts, which does not depend on the schedule.
#include "kernels/common/tile_walk.glsl"

layout(scalar, binding = SHADE_SUMS) coherent restrict buffer SumsOfParts
{
    uint partSums[];
};

// What a group shades: the tile, or the part of a list that begins with the page `list`.
struct TileWork {
    uint tile, list, part; // list is 0 if the group shades all lists that are not shared
};

// Returns what is at a place of workTiles.
TileWork tileWork(uint place)
{
    const uint entry = workTiles[place];
    if (IS_DISTANT || (entry & PART_OF_LIST) == 0u)
        return TileWork(entry, 0u, 0u);
    const uint list = entry & ~PART_OF_LIST, words = list * PAGE_WORDS;
    return TileWork(entryAt(words + 1u), list, place - entryAt(words + 3u));
}

// Returns the first block of a part. It has no light if the list has no more pages.
Block partBlock(LightBatch batch, TileWork work)
{
    Block block = pageBlock(work.list); // read again, for fewer registers
    for (uint i = 0u; i <= work.part * PART_PAGES; ++i)
        block = nextBlock(batch, block);
    return block;
}

// Stores the light of a part at the lane's pixel. In the lane that does so last of all parts, returns
// true and sets `light` to their sum.
bool sumOfParts(TileWork work, inout vec3 light)
{
    const uint words = work.list * PAGE_WORDS, parts = entryAt(words + 2u);
    const uint counter = entryAt(words + 4u) + gl_LocalInvocationIndex;
    const uint first = entryAt(words + 5u) + gl_LocalInvocationIndex;
    const uint at = first + work.part * SUM_PAGES * PAGE_WORDS;
    for (uint i = 0u; i < SUM_PAGES; ++i)
        partSums[at + i * PAGE_WORDS] = floatBitsToUint(light[i]);
    memoryBarrierBuffer();
    if (atomicAdd(partSums[counter], 1u) + 1u != parts)
        return false;
    memoryBarrierBuffer();
    partSums[counter] = 0u; // for a frame that keeps the list
    light = vec3(0.0);
    for (uint p = 0u; p < parts; ++p)
        for (uint i = 0u; i < SUM_PAGES; ++i)
            light[i] += uintBitsToFloat(partSums[first + (p * SUM_PAGES + i) * PAGE_WORDS]);
    return true;
}
