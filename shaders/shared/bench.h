// SPDX-License-Identifier: Apache-2.0
// Records that the program's benchmarks (tools/candelabra/measure) share with their kernels
// (shaders/bench), which measure the shipping shader functions.
#ifndef CND_SHARED_BENCH_H
#define CND_SHARED_BENCH_H

#include "shared/lighting_data.h"
#include "shared/prelude.h"

GPU_BEGIN

const uint BENCH_GROUP = 64u;

const uint BENCH_SHAPES = 2u; // after the lights (shared/lighting_data.h)
const uint BENCH_INPUT = 3u;
const uint BENCH_OUTPUT = 4u;
const uint BENCH_LTC = 40u; // kernels of bench/ltc: the table of shared/ltc.h

struct BenchParams {
    uint count;       // lanes
    uint lightCount;  // time_lights: lights that every lane evaluates
    uint sampleCount; // as in FrameParams
    uint sampleSeed;
};
GPU_SIZE(BenchParams, 16)

// A shaded point at the origin, before lights are known.
struct BenchReceiver {
    vec3 n; // unit
    vec3 v; // to the eye, any length but 0
    float perceptualRoughness;
};
GPU_SIZE(BenchReceiver, 28)

// The response to a light of unit emission: the form factor f, and the specular response with F = 1
// (a) and with F = (1 - VoH)^5 (b).
struct BenchResponse {
    float f, a, b;
};
GPU_SIZE(BenchResponse, 12)

// Specialisation constants in addition to those of lighting_data.h.
const uint SPEC_BENCH_EVALUATION = 16u; // time_lights: EVALUATE_*
// The ways of evaluation (shading/light_families.glsl).
const uint EVALUATE_ABOVE = 0u;   // sphere, or light with an outline, above the horizon
const uint EVALUATE_NEAR = 1u;    // sphere that nearly touches the horizon, or tiny across it
const uint EVALUATE_GENERAL = 2u; // any other light that reaches the point
const uint EVALUATE_NONE = 3u;    // light that does not reach the point

// --- sweep_inputs: random and adversarial inputs, generated from a seed and an index
#define CND_SWEEP_SLICES(X)                                                                        \
    X(0, ANYTHING, "anything: roughness, view, size and direction drawn freely")                   \
    X(1, SCALES, "distances and sizes from 1e-6 to 1e7 m")                                         \
    X(2, DENORMAL, "denormal distances, sizes, emissions and vector components")                   \
    X(3, CONTACT, "receiver on, inside, touching and at the centre of the emitter")                \
    X(4, ALIGNED, "V = N, L = N, L = R, L = V, and a hair beside them")                            \
    X(5, GRAZING, "view and light at and below the horizon")                                       \
    X(6, TANGENT, "emitters that touch the horizon")                                               \
    X(7, EXTREME_ALPHA, "alpha 0.002, below it, and 1")                                            \
    X(8, FAR_AWAY, "positions 1e5 to 1e6 m from the origin")                                       \
    X(9, EMISSION, "emission from 1e-8 to 1e9")                                                    \
    X(10, EDGE, "edges and corners in the mirror direction, sizes from 1e-4 to 10 distances")      \
    X(11, SLIVER, "lights with no or hardly any width or length, sizes from 1e-4 to 10 distances")

#define X(id, NAME, text) const uint SWEEP_##NAME = id;
CND_SWEEP_SLICES(X)
#undef X

const uint SWEEP_OUTPUT = 4u; // SweepRecord: one per lane when recording, else the first bad ones
const uint SWEEP_COUNTERS = 5u;
const uint SWEEP_MAX_BAD = 64u; // how many bad responses a dispatch keeps
struct SweepParams {
    uint count; // lanes
    uint slice; // SWEEP_*
    uint seed;
    uint firstIndex;
    uint sampleCount; // as in FrameParams
    uint sampleSeed;
    uint recordAll; // 1: record every lane, with lights of unit emission; 0: the first bad ones
    uint zero;      // 0, which compilers cannot know (see opaque() in bench/sweep_cases.glsl)
};
GPU_SIZE(SweepParams, 32)

// Numbers of responses. above: responses of a closed form that are above an upper bound of the
// exact response by more than the errors that SWEEP_CLOSED_FORM_ERROR and SWEEP_OUTLINE_ERROR
// allow. bad: responses that are any of the others.
struct SweepCounters {
    uint nan, infinite, negative, above, bad;
};
GPU_SIZE(SweepCounters, 20)

// The largest error allowed for a closed form, relative to the response on the mirror axis. It is
// far above the measured errors and far below the error of a formula that fails somewhere.
const float SWEEP_CLOSED_FORM_ERROR = 0.3f;
// The largest error allowed for the outline, as a share of the directions to a light that is as
// wide as it is long: the errors of two long edges do not cancel as the edges meet, whether they
// come from rounding or from the form that their integrals have.
const float SWEEP_OUTLINE_ERROR = 1e-2f;

// One configuration: the point and the light that light_eval.glsl gets, and the response.
struct SweepRecord {
    vec3 position; // m
    vec3 n;
    vec3 v;
    float perceptualRoughness;
    vec4 centreRadius;      // centre, bounding radius
    vec4 emissionInfluence; // emission, squared influence radius
    LightShape shape;
    vec3 response; // a BenchResponse when recording, else the outgoing luminance
    float bound;   // of the exact specular response with F = 1
    uint index;
};
GPU_SIZE(SweepRecord, 124)

GPU_END

#endif
