// SPDX-License-Identifier: Apache-2.0
// Finds the slots of lights in lists (shared/occluder_data.h).
layout(scalar, binding = SHADOW_PAGE_PAIRS) readonly buffer PagePairs
{
    uint pagePairs[];
};
layout(scalar, binding = SHADOW_ASKED) readonly buffer AskedPairBuffer
{
    AskedPairs asked;
    AskRecord askRecords[];
};

// Returns the slot of the light with index k in the entry buffer, SLOT_LIT or SLOT_DARK.
uint slotOfEntry(uint k)
{
    return askRecords[pagePairs[k / PAGE_WORDS] + k % PAGE_WORDS - 1u].slot;
}
