// SPDX-License-Identifier: Apache-2.0
// Every lane evaluates the same lights in one way, as the inner loop of shade_tiles.comp does. Run with
// two light counts: the difference of the times is the cost of the additional lights.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "bench/bench_lights.glsl"

layout(local_size_x = BENCH_GROUP) in;
layout(constant_id = SPEC_BENCH_EVALUATION) const uint evaluation = EVALUATE_ABOVE;
layout(scalar, binding = BENCH_INPUT) readonly buffer Input
{
    BenchReceiver receivers[];
};
layout(scalar, binding = BENCH_OUTPUT) writeonly buffer Output
{
    float sums[];
};

// `evaluation` is a specialisation constant, so only one of the calls remains.
vec3 evaluate(BENCH_RECEIVER r, uint light)
{
#define X(WAY, found, SUM, response)                                                               \
    if (evaluation == EVALUATE_##WAY)                                                              \
        return evaluate_##WAY(r, light);
    EVALUATIONS(X)
#undef X
    return vec3(0.0);
}

void main()
{
    const uint i = gl_GlobalInvocationID.x;
    if (i >= params.count)
        return;
    const BENCH_RECEIVER r = makeBenchReceiver(receivers[i]);
    vec3 sum = vec3(0.0);
    for (uint light = 0u; light < params.lightCount; ++light)
        sum += evaluate(r, light);
    sums[i] = sum.x + sum.y + sum.z;
}
