// SPDX-License-Identifier: Apache-2.0
// Radii of influence from an error (CND_INFLUENCE_BY_ERROR): what crosses between the lighting
// module and the kernels that measure the error and choose the radii.
#ifndef CND_SHARED_INFLUENCE_H
#define CND_SHARED_INFLUENCE_H

#include "shared/lighting.h"

GPU_BEGIN

// One illuminance is cut at for all lights of a frame: a light of peak intensity I reaches as far
// as I / d^2 is above it. Candidates begin at the lower ends of bins of exposed illuminance
// (illuminance times exposure): half octaves from 2^INFLUENCE_FINEST, and a few bins of two octaves
// below, where only lights end that nobody sees. Cut b leaves out bins 0 .. b - 1; cut 0 leaves out
// nothing.
const uint INFLUENCE_BINS = 40u;
const uint INFLUENCE_COARSE_BINS = 6u;
const float INFLUENCE_FINEST = -22.0f;
// What a sample keeps: the luminance of the lights of each bin, and that of distant lights.
const uint INFLUENCE_DISTANT = 40u;
const uint INFLUENCE_SLOTS = 41u;

// Pixels that are measured lie in squares of `spacing` pixels, one each, another one every frame.
// Squares grow with the image, so that there are no more than this. After spacing^2 frames, a
// period, all pixels have been measured, and cuts may rise to what all of them allowed.
const uint INFLUENCE_MAX_SAMPLES = 4096u;
const uint INFLUENCE_MIN_SPACING = 8u;
// A history begins with the pixels of so many frames at once, at most; those of later frames follow
// behind them.
const uint INFLUENCE_MAX_ROUNDS = 256u;

struct InfluenceFrame {
    uvec2 size;    // pixels
    uvec2 samples; // squares
    uint spacing;  // a power of two
    uint rounds;   // that a history begins with
    uint owner;    // number of the history; states of another one are none
    uint previous; // index of the state of the frame before; this frame's is the other
    uint toneMap;  // TONEMAP_*
    float clearDepth;
    float exposure; // > 0
    float maxError; // of the display, 0..1
};
GPU_SIZE(InfluenceFrame, 48)

struct InfluenceState {
    uint owner;
    uint frame;  // of the history
    uvec2 size;  // of the image; another one begins a new period
    uint seen;   // frames of this period, with this one
    uint cut;    // of the frame
    uint target; // towards which cuts rise
    uint lowest; // allowed by the frames of this period
};
GPU_SIZE(InfluenceState, 32)

struct InfluenceData {
    InfluenceFrame frame; // written with every frame
    uint allowed;         // likewise: INFLUENCE_BINS - 1; becomes the lowest over all samples
    InfluenceState states[2];
};
GPU_SIZE(InfluenceData, 116)

// --- measure_influence: lights of one type. The kernel evaluates lights as shade_brute does and
// has the same bindings except SHADE_RADIANCE. Several lanes share one sample: each takes some of
// the lights and keeps its own sums in shared memory. Every device has shared memory for 32 lanes.
const uint MEASURE_INFLUENCE_GROUP = 32u;
const uint MEASURE_INFLUENCE_LANES = 16u; // per sample
const uint MEASURE_INFLUENCE_DATA = 40u;
const uint MEASURE_INFLUENCE_SUMS = 41u; // vec3, INFLUENCE_SLOTS per sample
struct MeasureInfluenceParams {
    LightBatch batch;
    uint round; // the frame's round of measuring, from 0
};
GPU_SIZE(MeasureInfluenceParams, 12)

// --- choose_influence: one lane per sample
const uint CHOOSE_INFLUENCE_GROUP = 64u;
const uint CHOOSE_INFLUENCE_DATA = 0u;
const uint CHOOSE_INFLUENCE_SUMS = 1u;
const uint CHOOSE_INFLUENCE_DEPTH = 2u;
const uint CHOOSE_INFLUENCE_RADIANCE = 3u;
struct ChooseInfluenceParams {
    uint samples;
    uint round; // the frame's round of measuring, from 0
};
GPU_SIZE(ChooseInfluenceParams, 8)

// --- cut_lights: one lane per light of one type
const uint CUT_LIGHTS_GROUP = 64u;
const uint CUT_LIGHTS_DATA = 0u;
const uint CUT_LIGHTS_CORE = 1u;
const uint CUT_LIGHTS_SHAPES = 2u;
const uint CUT_LIGHTS_COUNTERS = 3u;
struct CutLightsParams {
    uint firstLight, lightCount;
    uint type; // LIGHT_*
};
GPU_SIZE(CutLightsParams, 12)

GPU_END

#endif
