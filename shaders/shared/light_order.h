// SPDX-License-Identifier: Apache-2.0
// Sorting lights so that neighbours in memory are neighbours in space: by type, class of size, and
// place along a Morton curve. A stable radix sort without atomics: a lane counts and scatters a run
// of consecutive lights by itself, so the order depends on nothing but the lights.
#ifndef CND_SHARED_LIGHT_ORDER_H
#define CND_SHARED_LIGHT_ORDER_H

#include "shared/light_types.h"
#include "shared/prelude.h"

GPU_BEGIN

struct LightKey {
    uint key;
    uint light; // index in LightRecord order
};
GPU_SIZE(LightKey, 8)

// Bits of a key, from the top: type, class of influence radius, Morton code.
const uint ORDER_TYPE_BITS = LIGHT_TYPE_COUNT <= 8u ? 3u : 4u;
const uint ORDER_SIZE_BITS = 3u;

// Digit of a sorting pass. 64 counters fit a lane's private memory; 24 bits take four passes.
const uint SORT_DIGIT_BITS = 6u;
const uint SORT_DIGITS = 64u;
// Lights that one lane counts and scatters. Longer runs cost devices with many lanes time, shorter
// ones are outweighed by their 64 counters.
const uint SORT_RUN = 256u;
const uint SORT_GROUP = 64u;
const uint SORT_SUM = 256u; // counters that one lane sums

// --- light_keys: one lane per light
const uint LIGHT_KEYS_RECORDS = 0u;
const uint LIGHT_KEYS_KEYS = 1u;
struct LightKeysParams {
    vec3 low; // m: corner of the Morton grid; lights outside count to its border
    float cellsPerMetre;
    uint lightCount;
    uint axisBits;       // of the Morton code, per axis
    int largestExponent; // of influence radii (base 2) of the last class but one
};
GPU_SIZE(LightKeysParams, 28)

// --- sort_count, sort_sums, sort_offsets, sort_scatter: one pass over a digit
const uint SORT_COUNT_KEYS = 0u;
const uint SORT_COUNT_COUNTS = 1u; // [digit][run]
const uint SORT_SUMS_COUNTS = 0u;  // in place: exclusive sums within SORT_SUM counters
const uint SORT_SUMS_SUMS = 1u;
const uint SORT_OFFSETS_SUMS = 0u; // in place: exclusive sums
const uint SORT_SCATTER_FROM = 0u;
const uint SORT_SCATTER_TO = 1u;
const uint SORT_SCATTER_COUNTS = 2u;
const uint SORT_SCATTER_SUMS = 3u;
struct SortParams {
    uint lightCount;
    uint runCount;
    uint shift; // of the digit
};
GPU_SIZE(SortParams, 12)

GPU_END

#endif
