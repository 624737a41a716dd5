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

// A position in a list and the light found there.
struct Walk {
    TileList list;
    uint k; // list.count at the end
    uint light;
    vec4 centreRadius;
    vec4 emissionInfluence;
};

// Moves to the first entry at or after walk.k whose light reaches the point.
void seek(inout Walk walk, vec3 position, vec3 n)
{
    const uint last = walk.list.count - 1u;
    bool reaches = false;
    while (walk.k < walk.list.count && !reaches) {
        const uint k = min(walk.k, last);
        walk.light = walk.list.offset == UNLISTED ? k : entries[walk.list.offset + k];
        walk.centreRadius = lightCentre(walk.light);
        walk.emissionInfluence = lightEmission(walk.light);
        reaches = lightReaches(position, n, walk.centreRadius, walk.emissionInfluence.w);
        walk.k += reaches ? 0u : 1u;
    }
}
