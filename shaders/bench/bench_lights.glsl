// SPDX-License-Identifier: Apache-2.0
// Bindings of the benchmark kernels, and the evaluation of the lights bound there: the shipping one or,
// with LTC, linearly transformed cosines.
#ifdef LTC
#define LIGHT_FAMILY_POLYGON
#endif
#include "shared/bench.h"
#include "lib/gbuffer.glsl"
#include "lib/brdf.glsl"
#include "kernels/common/light_stream.glsl"

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

#include "bench/evaluate_classified.glsl"

#ifdef LTC
#include "bench/ltc/lights.glsl"
#define BENCH_RECEIVER LtcReceiver
#define FINISH_RECEIVER makeLtcReceiver
#else
#define BENCH_RECEIVER Receiver
#define FINISH_RECEIVER
#endif

BENCH_RECEIVER makeBenchReceiver(BenchReceiver receiver)
{
    const Surface surface =
        Surface(receiver.n, vec3(0.0), vec3(0.0), 1.0, receiver.perceptualRoughness);
    ShadingPoint p = makeShadingPoint(surface, vec3(0.0), receiver.v);
    separateLobes(p);
    return FINISH_RECEIVER(makeReceiver(p, params.sampleCount, params.sampleSeed));
}
