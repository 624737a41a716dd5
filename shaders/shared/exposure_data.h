// SPDX-License-Identifier: Apache-2.0
// Everything that crosses between the exposure module and its kernels.
#ifndef CND_SHARED_EXPOSURE_DATA_H
#define CND_SHARED_EXPOSURE_DATA_H

#include "shared/prelude.h"

GPU_BEGIN

// The bin of a luminance is taken from the bits of the float: the exponent and 3 bits of mantissa
// make 8 bins per octave, of equal width inside the octave, over 32 octaves from 2^-12 to
// 2^20 cd/m^2 (EV100 -9 to 23). The next 4 bits of mantissa are summed per bin, so that the mean
// inside a bin is known too.
const uint HISTOGRAM_BINS = 256u;
const uint HISTOGRAM_BIN_SHIFT = 20u;
const uint HISTOGRAM_FRACTION_SHIFT = 16u;
const uint HISTOGRAM_FRACTIONS = 16u;
const uint HISTOGRAM_FIRST_CODE = 920u; // (127 - 12) * 8
const int HISTOGRAM_MIN_EXPONENT = -12;
const float HISTOGRAM_MIN_LUMINANCE = 0.000244140625f; // 2^-12
const float HISTOGRAM_MAX_LUMINANCE = 1048576.0f;      // 2^20
// Pixels below the smallest normal float (also zero and negative ones) have no light at all, for
// instance an empty background. They are counted but are not part of the average, unless there are
// no other pixels.
const float HISTOGRAM_BLACK = 1.17549435e-38f; // 2^-126; devices may flush what is smaller
const uint MAX_METERING_WEIGHT = 15u;

const uint METERING_AVERAGE = 0u; // CndMetering
const uint METERING_CENTRE_WEIGHTED = 1u;
const uint METERING_MASK = 2u;

struct HistogramData {
    uint counts[HISTOGRAM_BINS];     // sums of weights
    uvec2 fractions[HISTOGRAM_BINS]; // sums of weight * fraction, 64 bit: low, high
    uint invalidPixels;              // NaN luminance
    uint blackWeight;                // weight in counts[0] of pixels without any light
};
GPU_SIZE(HistogramData, 3080)

struct ExposureState {
    float targetEv100;
    float adaptedEv100;
    float exposure; // factor on luminance, including the exposure compensation
    uint owner;     // AdaptExposureParams::owner of the frame that wrote it
};
GPU_SIZE(ExposureState, 16)
// The number of the first exposure object. Each object has its own number. It treats a state with
// another number as no history, because the memory may come from a destroyed object. The numbers
// count up from a value that fresh memory is unlikely to hold. So the first frame of an object that
// is executed starts without a history, even if frames before it were recorded but never submitted.
const uint EXPOSURE_FIRST_OWNER = 0xE5C0F10Eu;

// --- luminance_histogram: one group per block of pixels. A group packs the count and the fraction
// sum of a bin into one word: the count is at most 1024 pixels * weight 15 < 2^14, the fraction sum
// at most 15 times that, < 2^18.
const uint HISTOGRAM_GROUP = 64u;
const uint HISTOGRAM_COLUMNS = 32u;       // pixels of a group along x
const uint HISTOGRAM_ROWS = 32u;          // pixels of a group along y
const uint HISTOGRAM_ROWS_PER_LANE = 16u; // a lane takes so many pixels of a column
const uint HISTOGRAM_COUNT_SHIFT = 18u;
const uint HISTOGRAM_RADIANCE = 0u;
const uint HISTOGRAM_MASK = 1u;
const uint HISTOGRAM_DATA = 2u;
struct LuminanceHistogramParams {
    uvec2 size;
    uvec2 maskSize;
    uvec2 firstTexel; // texel of the radiance image at which the frame begins
};
GPU_SIZE(LuminanceHistogramParams, 24)

// --- adapt_exposure: one group, one lane per bin
const uint ADAPT_DATA = 0u;
const uint ADAPT_STATE = 1u;
struct AdaptExposureParams {
    uint manual; // 0 or 1
    uint reset;  // 0 or 1
    float manualEv100;
    float compensation;
    float middleGrey; // exposed value of the luminance that EV100 stands for
    float minEv100, maxEv100;
    uint lowShare, highShare; // shares ignored at the dark and the bright end, times 2^32
    float keepUp, keepDown;   // exp(-dt speed): share of the distance to the target that remains
    uint owner;               // number of the exposure object
};
GPU_SIZE(AdaptExposureParams, 48)

// --- tone_map: a lane takes TONE_MAP_ROWS pixels of a column, since llvmpipe's cost of starting a
// lane is a tenth of that of a pixel
const uint TONE_MAP_GROUP = 64u; // lanes along x
const uint TONE_MAP_ROWS = 8u;
const uint TONE_MAP_RADIANCE = 0u;
const uint TONE_MAP_STATE = 1u;
const uint TONE_MAP_DISPLAY = 2u;
struct ToneMapParams {
    uvec2 size;
    uint dither; // 0 or 1
    uint ditherSeed;
    uvec2 firstTexel; // texel of both images at which the frame begins
};
GPU_SIZE(ToneMapParams, 24)

const uint TONEMAP_NONE = 0u; // CndToneMap
const uint TONEMAP_REINHARD = 1u;
const uint TONEMAP_ACES = 2u;
const uint TONEMAP_PBR_NEUTRAL = 3u;
const uint TONEMAP_AGX = 4u;
const uint SPEC_TONE_MAP = 0u;      // tone_map: TONEMAP_*
const uint SPEC_METERING = 1u;      // luminance_histogram: METERING_*
const uint SPEC_DISPLAY_STEPS = 2u; // tone_map: the largest code of a channel of the display

GPU_END

#endif
