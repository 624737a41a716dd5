// SPDX-License-Identifier: Apache-2.0
// Bindings of the benchmark kernels, and the shipping evaluation of the lights bound there.
#include "shared/bench.h"
#include "lib/gbuffer.glsl"
#include "lib/brdf.glsl"
#define LIGHT_STREAM_CORE BENCH_CORE
#define LIGHT_STREAM_CORE_WORDS BENCH_CORE_WORDS
#include "kernels/common/light_stream.glsl"
#include "bench/ltc_table.glsl"

layout(push_constant, scalar) uniform Push
{
    BenchParams params;
};
layout(scalar, binding = BENCH_SHAPES) readonly buffer LightShapes
{
    LightShape lightShapes[];
};

uint lightAt(uint k)
{
    return k;
}

#include "shading/light_walk.glsl"

#include "bench/evaluate_classified.glsl"

Receiver makeBenchReceiver(BenchReceiver receiver)
{
    const Surface surface =
        Surface(receiver.n, vec3(0.0), vec3(0.0), 1.0, receiver.perceptualRoughness);
    ShadingPoint p = makeShadingPoint(surface, vec3(0.0), receiver.v);
    separateLobes(p);
    return makeReceiver(p, params.errorBudget, params.sampleCount, params.sampleSeed);
}
