// SPDX-License-Identifier: Apache-2.0
// Walks a tile's light list in blocks: testing is in step, so its cost is one pass over the list; what
// the lanes found differs little between neighbours, so shading it diverges little.
layout(scalar, binding = SHADE_LISTS) readonly buffer Lists
{
    TileList lists[];
};
layout(scalar, binding = SHADE_ENTRIES) readonly buffer Entries
{
    uint entries[];
};

// Light at entry k of a list.
uint listedLight(TileList list, uint k)
{
    return list.offset == UNLISTED ? params.firstLight + k : entries[list.offset + k];
}

const uint WALK_BLOCK = 32u; // entries tested together: bits of a word

// One bit per entry of a block, set when the light reaches the point.
uint findReaching(TileList list, uint first, vec3 position, vec3 n)
{
    const uint count = min(WALK_BLOCK, list.count - first);
    uint found = 0u;
    for (uint i = 0u; i < count; ++i) {
        const uint light = listedLight(list, first + i);
        if (lightReaches(position, n, lightCentre(light), lightEmission(light).w))
            found |= 1u << i;
    }
    return found;
}
