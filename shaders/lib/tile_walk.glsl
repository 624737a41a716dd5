// SPDX-License-Identifier: Apache-2.0
// Walks a tile's light list. The seek loop runs per lane, so lanes that skip a light do not wait for
// lanes that shade it: nearly free of divergence on wide and on 8-lane devices alike.
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
    return list.offset == UNLISTED ? k : entries[list.offset + k];
}

// First entry at or after k whose light reaches the point; list.count when there is none.
uint seek(TileList list, uint k, vec3 position, vec3 n)
{
    while (k < list.count) {
        const uint light = listedLight(list, k);
        if (lightReaches(position, n, lightCentre(light), lightEmission(light).w))
            break;
        ++k;
    }
    return k;
}
