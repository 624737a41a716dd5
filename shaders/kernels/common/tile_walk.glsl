// SPDX-License-Identifier: Apache-2.0
// The lights of a pixel's cluster, as blocks for light_walk.glsl. Distant lights are in no list,
// because they light every cluster: they are consecutive, a batch.
#include "shading/light_type.glsl"
#include "kernels/common/tile_of_group.glsl"

layout(scalar, binding = SHADE_ENTRIES) readonly buffer Entries
{
    uint entries[];
};
layout(binding = SHADE_ENTRY_TEXELS) uniform utextureBuffer entryTexels;

uint entryAt(uint i)
{
    return READ_UINT(entries, entryTexels, i);
}

// Returns the light with index k. Blocks are ranges of such indices.
uint lightAt(uint k)
{
    return IS_DISTANT ? k : entryAt(k);
}

struct Block {
    uint first, count; // a count of 0 ends the walk; `first` is a readable index even then
    uint next;         // where the next block begins; 0: there is none
};

Block pageBlock(uint page)
{
    const uint header = entryAt(page * PAGE_WORDS);
    return Block(page * PAGE_WORDS + 1u, header & ((1u << PAGE_COUNT_BITS) - 1u),
                 header >> PAGE_COUNT_BITS);
}

// Returns the block of a batch that begins after its first `at` lights.
Block batchBlock(LightBatch batch, uint at)
{
    const uint left = batch.count - at;
    return Block(batch.first + at, min(left, PAGE_WORDS),
                 left > PAGE_WORDS ? at + PAGE_WORDS : 0u);
}

// Returns the first block of a sample. `batch`: the lights, if they are distant. It is empty if no
// light reaches the sample's cluster.
Block beginWalk(LightBatch batch, uint tile, float depth)
{
    if (IS_DISTANT)
        return batchBlock(batch, 0u);
    const uint list = lists[clusterOf(tile, depth)];
    const bool listed = list != LIST_EMPTY && list != LIST_UNLISTED && list != LIST_LONG;
    return listed ? pageBlock(list) : Block(0u, 0u, 0u);
}

Block nextBlock(LightBatch batch, Block block)
{
    if (block.next == 0u)
        return Block(block.first, 0u, 0u);
    const Block next = IS_DISTANT ? batchBlock(batch, block.next) : pageBlock(block.next);
    return next.count != 0u ? next : Block(block.first, 0u, 0u);
}
