// SPDX-License-Identifier: Apache-2.0
// Radii of influence from an error bound (CND_INFLUENCE_BY_ERROR): what crosses between the
// lighting module and the kernels that measure the error and choose the radii.
#ifndef CND_SHARED_INFLUENCE_DATA_H
#define CND_SHARED_INFLUENCE_DATA_H

#include "shared/lighting_data.h"

GPU_BEGIN

// All lights of a frame are cut at one illuminance: a light of peak intensity I reaches to the
// distance d where I / d^2 falls to it. The candidates for this illuminance are the lower ends of
// bins of exposed illuminance (illuminance times exposure). The bins are half octaves from
// 2^INFLUENCE_FINEST on; below that are a few bins of two octaves, for illuminances that are
// invisible. Cut b leaves out the bins 0 .. b - 1; cut 0 leaves out nothing.
const uint INFLUENCE_BINS = 40u;
const uint INFLUENCE_COARSE_BINS = 6u;
const float INFLUENCE_FINEST = -22.0f;
// A sample stores one luminance per slot: that of the lights of each bin, and that of distant
// lights.
const uint INFLUENCE_DISTANT = 40u;
const uint INFLUENCE_SLOTS = 41u;

// The image is divided into squares with sides of `spacing` pixels. In every frame another pixel of
// each square is measured. The squares grow with the image, so that there are at most
// INFLUENCE_MAX_SAMPLES of them. After a period, spacing^2 frames, all pixels have been measured,
// and cuts may rise as far as all of them allowed.
const uint INFLUENCE_MAX_SAMPLES = 4096u;
const uint INFLUENCE_MIN_SPACING = 8u;
// The first frame of a history measures the pixels of up to this many frames at once. Later frames
// continue after them.
const uint INFLUENCE_MAX_ROUNDS = 256u;

struct InfluenceFrame {
    uvec2 size;    // pixels
    uvec2 samples; // squares
    uint spacing;  // a power of two
    uint rounds;   // how many pixels per square the first frame of a history measures
    uint owner;    // number of the history; states with another number do not count
    uint previous; // index of the previous frame's state; this frame has the other one
    uint toneMap;  // TONEMAP_*
    float clearDepth;
    float exposure;                    // > 0
    float maxError;                    // largest change of a display value, 0..1
    uvec2 firstTexel, firstDepthTexel; // those of FrameParams
};
GPU_SIZE(InfluenceFrame, 64)

struct InfluenceState {
    uint owner;
    uint frame;  // number of the frame in its history
    uvec2 size;  // size of the image; a new size begins a new period
    uint seen;   // frames of this period, including this one
    uint cut;    // cut of this frame
    uint target; // the cut rises to this
    uint lowest; // lowest cut that a frame of this period allowed
};
GPU_SIZE(InfluenceState, 32)

struct InfluenceData {
    InfluenceFrame frame; // written in every frame
    // Written as INFLUENCE_BINS - 1 in every frame. It becomes the lowest cut that a sample allows.
    uint allowed;
    InfluenceState states[2];
};
GPU_SIZE(InfluenceData, 132)

// --- measure_influence: lights of one type. The kernel evaluates lights as shade_brute does and
// has the same bindings except RADIANCE_IMAGE. Several lanes share one sample: each takes some of
// the lights and keeps its own sums in shared memory. Every device has shared memory for 32 lanes.
const uint MEASURE_INFLUENCE_GROUP = 32u;
const uint MEASURE_INFLUENCE_LANES = 16u; // per sample
const uint MEASURE_INFLUENCE_DATA = 40u;
const uint MEASURE_INFLUENCE_SUMS = 41u; // vec3, INFLUENCE_SLOTS per sample
struct MeasureInfluenceParams {
    LightBatch batch;
    uint round;       // the frame's round of measuring, from 0
    uint firstSample; // a dispatch takes a part of the samples if there are many lights
};
GPU_SIZE(MeasureInfluenceParams, 16)

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
