// SPDX-License-Identifier: Apache-2.0
// The buffer of asked pairs. The includer defines ASKED_PAIRS, its binding, and ASKED_ACCESS,
// readonly or nothing. It has params.capacity, the number of slots.
layout(scalar, binding = ASKED_PAIRS) ASKED_ACCESS buffer AskedPairBuffer
{
    AskedPairs asked;
    uint askedWords[];
};

// The functions placeOf...() return where something is stored, as indices of askedWords.
uint placeOfPair(uint pair)
{
    return PAIR_WORDS * pair;
}

// Returns the record of a pair. Its member `slot` is not read, and is 0.
AskRecord askRecord(uint pair)
{
    const uint at = placeOfPair(pair);
    return AskRecord(askedWords[at], askedWords[at + 1u], askedWords[at + 2u], 0u);
}

uint placeOfRecord(uint slot)
{
    return PAIR_WORDS * PAIRS_PER_SLOT * params.capacity + RECORD_WORDS * slot;
}

// The slot with index `at` of those of a kind.
uint placeOfSlot(uint kind, uint at)
{
    return (PAIR_WORDS * PAIRS_PER_SLOT + RECORD_WORDS + kind) * params.capacity + at;
}

uint placeOfItem(uint item)
{
    return placeOfSlot(SLOT_KINDS, item);
}
