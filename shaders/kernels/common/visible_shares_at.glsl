// SPDX-License-Identifier: Apache-2.0
// Reads the slots of pair_visibility (shared/occluder_data.h) for the lights of tile_walk.glsl.
#include "shading/shadow_view.glsl"

layout(scalar, binding = SHADOW_SLOTS) readonly buffer Slots
{
    uint slots[];
};
#include "kernels/common/slot_of_entry.glsl"

uint walkedTile; // the tile of this group

// Returns the slot of the light with index k, SLOT_LIT or SLOT_DARK. The slots of distant lights follow
// one another tile by tile.
uint slotAt(uint k)
{
    if (shadowView.asks == 0u)
        return SLOT_LIT;
    if (IS_DISTANT)
        return shadowView.distantSlots[lightType] + params.batch.first * shadowView.distantStride +
               walkedTile * params.batch.count + k - params.batch.first;
    return slotOfEntry(k);
}

// Returns the visible shares of the light with index k at this lane's pixel.
uint visibleSharesAt(uint k)
{
    const uint slot = slotAt(k);
    if (slot >= SLOT_DARK)
        return slot == SLOT_LIT ? SHARES_LIT : 0u;
    return slots[slot * SLOT_WORDS + gl_LocalInvocationIndex];
}
