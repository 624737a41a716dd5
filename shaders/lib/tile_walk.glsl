// SPDX-License-Identifier: Apache-2.0
// The light list of a tile as the lights of light_walk.glsl: set `tileList`, then walk.
layout(scalar, binding = SHADE_LISTS) readonly buffer Lists
{
    TileList lists[];
};
layout(scalar, binding = SHADE_ENTRIES) readonly buffer Entries
{
    uint entries[];
};

TileList tileList;

void setTileList(uint tile)
{
    tileList.offset = lists[tile].offset;
    tileList.count = lists[tile].count;
}

// Light at entry k of the list.
uint lightAt(uint k)
{
    return tileList.offset == UNLISTED ? params.firstLight + k : entries[tileList.offset + k];
}
