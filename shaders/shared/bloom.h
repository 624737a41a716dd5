// SPDX-License-Identifier: Apache-2.0
// Data that the program's bloom and its kernels share.
//
// Along each axis, a level of n texels is followed by a coarser one of m = ceil(n / 2) texels, over
// the same length. Lengths are counted in units of which a fine texel has m and a coarse one n, so
// that all weights follow from integers.
#ifndef CND_SHARED_BLOOM_H
#define CND_SHARED_BLOOM_H

#include "shared/prelude.h"

GPU_BEGIN

const uint BLOOM_GROUP = 8u; // x and y, of both kernels

// --- bloom_down: makes a level from the next finer one, one lane per texel
const uint BLOOM_DOWN_FINE = 0u;
const uint BLOOM_DOWN_COARSE = 1u;
struct BloomDownParams {
    uvec2 fineSize, coarseSize;
};
GPU_SIZE(BloomDownParams, 16)

// --- bloom_up: adds a level, made finer, to the next finer level, one lane per texel. The output
// may be the finer level itself.
const uint BLOOM_UP_FINE = 0u;
const uint BLOOM_UP_COARSE = 1u;
const uint BLOOM_UP_OUTPUT = 2u;
struct BloomUpParams {
    uvec2 fineSize, coarseSize;
    float fineWeight, coarseWeight; // factors on the two levels
};
GPU_SIZE(BloomUpParams, 24)

GPU_END

#endif
