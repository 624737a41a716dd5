// SPDX-License-Identifier: Apache-2.0
// Reads the lists of the baselines as blocks for light_walk.glsl.
#include "kernels/common/page_header.glsl"
#include "shared/baselines.h"

layout(constant_id = SPEC_BASELINE) const uint baseline = BASELINE_OF_TILES;
layout(scalar, binding = BASELINE_HEADS) readonly buffer Heads
{
    uint heads[];
};
layout(scalar, binding = BASELINE_ENTRIES) readonly buffer Entries
{
    uint entries[];
};
layout(scalar, binding = BASELINE_GRID) readonly buffer Grid
{
    BaselineGrid grid;
};

uint lightAt(uint k)
{
    return entries[k];
}

struct Block {
    uint first, count; // a count of 0 ends the walk; `first` is a readable index even then
    uint next; // tiles: next page; froxels: number of lights left
};

Block pageBlock(uint page)
{
    const uint header = entries[page * PAGE_WORDS];
    return Block(page * PAGE_WORDS + 1u, lightsOfPage(header), pageAfter(header));
}

Block runBlock(uint first, uint left)
{
    const uint count = min(left, 64u);
    return Block(count != 0u ? first : 0u, count, left - count);
}

Block beginWalk(uvec2 pixel, float distance_)
{
    if (baseline == BASELINE_OF_TILES) {
        const uvec2 tile = pixel / BASELINE_TILE_SIZE;
        const uint head = heads[tile.y * grid.count.x + tile.x];
        return head != 0u ? pageBlock(head / PAGE_WORDS) : Block(0u, 0u, 0u);
    }
    const uvec2 column = pixel / FROXEL_SIZE;
    const float slice = log2(max(distance_, grid.nearest) / grid.nearest) * grid.slicesPerOctave;
    const uint z = uint(min(slice, float(FROXEL_SLICES - 1u)));
    const uint at = (z * grid.count.y + column.y) * grid.count.x + column.x;
    return runBlock(heads[at], heads[at + 1u] - heads[at]);
}

Block nextBlock(Block block)
{
    if (block.next == 0u)
        return Block(block.first, 0u, 0u);
    return baseline == BASELINE_OF_TILES ? pageBlock(block.next)
                                         : runBlock(block.first + block.count, block.next);
}
