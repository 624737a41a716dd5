// SPDX-License-Identifier: Apache-2.0
// Data that the program's accumulation of frames and its kernel share.
#ifndef CND_SHARED_ACCUMULATE_H
#define CND_SHARED_ACCUMULATE_H

#include "shared/prelude.h"

GPU_BEGIN

// --- accumulate: adds what a frame shows to what the frames before showed, one lane per pixel
const uint ACCUMULATE_GROUP = 8u; // x and y
const uint ACCUMULATE_RADIANCE = 0u;
const uint ACCUMULATE_SAMPLE = 1u; // the display image of the frame
const uint ACCUMULATE_RADIANCE_SUM = 2u;
const uint ACCUMULATE_DISPLAY_SUM = 3u; // of linear light, not of the encoded values
const uint ACCUMULATE_DISPLAY = 4u;     // receives the mean of the display images
struct AccumulateParams {
    uvec2 size;
    // The place in its pixels where the frame sees the scene, from -0.5 to 0.5 pixels from their
    // centres.
    vec2 offset;
    uint index; // of the frame; the first one starts new sums
    // 0: a frame is added. Otherwise the means of so many frames replace radiance and display
    // image.
    uint count;
    uint dither; // 1: the mean of the display images is dithered
};
GPU_SIZE(AccumulateParams, 28)

GPU_END

#endif
