// SPDX-License-Identifier: Apache-2.0
// Sorting of lights by type, class of influence radius and position along a Morton curve, so that
// neighbours in memory are neighbours in space. It is a stable radix sort: runs of consecutive
// lights are counted and scattered, so the order depends only on the lights. A run is the work of a
// group on GPUs, and of a lane on CPU devices (kernels/cpu).
#ifndef CND_SHARED_LIGHT_ORDER_DATA_H
#define CND_SHARED_LIGHT_ORDER_DATA_H

#include "shared/light_type_list.h"
#include "shared/prelude.h"

GPU_BEGIN

struct LightKey {
    uint key;
    uint light; // index in LightRecord order
};
GPU_SIZE(LightKey, 8)

// Bits of a key, from the top: the number of present types before the light's, class of influence
// radius, Morton code. So the key is longer than 24 or 30 bits only if more than 8 types are
// present.
const uint ORDER_SIZE_BITS = 3u;

// Bits of the digit that a pass sorts by. 64 counters fit into a lane's private memory, and a key
// of 24 bits takes four passes.
const uint SORT_DIGIT_BITS = 6u;
const uint SORT_DIGITS = 64u;
// Lights of a run. Longer runs leave lanes of large devices without work; with shorter runs most of
// the time goes into the 64 counters of each run.
const uint SORT_RUN = 256u;
const uint SORT_GROUP = 64u;
const uint SORT_SUM = 256u; // how many counters one group or lane sums

// --- light_keys: one lane per light
const uint LIGHT_KEYS_RECORDS = 0u;
const uint LIGHT_KEYS_KEYS = 1u;
struct LightKeysParams {
    vec3 low; // m; lowest corner of the Morton grid; a light outside belongs to the nearest cell
    float cellsPerMetre;
    uint lightCount;
    uint axisBits;       // bits of the Morton code per axis
    int largestExponent; // largest binary exponent of influence radii in the last class but one
    uint types;          // mask of 1 << type of the types that are present
};
GPU_SIZE(LightKeysParams, 32)

// --- sort_count, sort_sums, sort_offsets, sort_scatter, and sort_lights of kernels/cpu: one pass
// over a digit; all have these bindings
const uint SORT_FROM = 0u; // LightKey
const uint SORT_TO = 1u;
const uint SORT_COUNTS = 2u; // [digit][run], replaced by exclusive sums over each SORT_SUM of them
const uint SORT_SUMS = 3u;   // totals of these, replaced by exclusive sums over all
// Specialisation constant of sort_lights, and its values: which of the kernels it replaces.
const uint SPEC_SORT_STEP = 0u;
const uint SORT_STEP_COUNT = 0u;
const uint SORT_STEP_SUMS = 1u;
const uint SORT_STEP_SCATTER = 2u;
struct SortParams {
    uint lightCount;
    uint runCount;
    uint shift; // lowest bit of the digit
};
GPU_SIZE(SortParams, 12)

GPU_END

#endif
