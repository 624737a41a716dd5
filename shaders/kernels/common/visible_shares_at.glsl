// SPDX-License-Identifier: Apache-2.0
// Reads the slots of pair_visibility (shared/occluder_data.h) for the lights of tile_walk.glsl.
#include "shading/shadow_view.glsl"

layout(scalar, binding = SHADOW_SLOTS) readonly buffer Slots
{
    uint slots[];
};
layout(scalar, binding = SHADOW_PAGE_SLOTS) readonly buffer PageSlots
{
    uint pageSlots[];
};

uint walkedTile; // the tile of this group

// Returns the visible shares of the light with index k at this lane's pixel. The slots of distant
// lights follow one another tile by tile.
uint visibleSharesAt(uint k)
{
    if (shadowView.asks == 0u)
        return SHARES_LIT;
    uint slot = pageSlots[k / PAGE_WORDS] + k % PAGE_WORDS - 1u;
    if (IS_DISTANT)
        slot = shadowView.distantSlots[lightType] + params.batch.first * shadowView.distantStride +
               walkedTile * params.batch.count + k - params.batch.first;
    return slots[slot * SLOT_WORDS + gl_LocalInvocationIndex];
}
