// SPDX-License-Identifier: Apache-2.0
// The buffer of asked pairs. The includer defines ASKED_PAIRS, its binding, and ASKED_ACCESS,
// readonly or nothing. It has params.capacity, the number of slots.
layout(scalar, binding = ASKED_PAIRS) ASKED_ACCESS buffer AskedPairBuffer
{
    AskedPairs asked;
    uint askedWords[];
};

// Returns where the words of an AskRecord are stored.
uint placeOfRecord(uint slot)
{
    return RECORD_WORDS * slot;
}

AskRecord askRecord(uint slot)
{
    const uint at = placeOfRecord(slot);
    return AskRecord(askedWords[at], askedWords[at + 1u], askedWords[at + 2u],
                     askedWords[at + RECORD_ITEMS]);
}

// Returns where the slot of a pair is stored: the pair with index `at` of its kind.
uint placeOfSlot(uint kind, uint at)
{
    return (RECORD_WORDS + kind) * params.capacity + at;
}

uint placeOfItem(uint item)
{
    return (RECORD_WORDS + PAIR_KINDS) * params.capacity + ITEM_WORDS * item;
}
