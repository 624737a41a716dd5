// SPDX-License-Identifier: Apache-2.0
// Response of receiver i to light i, evaluated by the shipping code of one light type and specular
// method.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "bench/bench_lights.glsl"

layout(local_size_x = BENCH_GROUP) in;
layout(scalar, binding = BENCH_INPUT) readonly buffer Input
{
    BenchReceiver receivers[];
};
layout(scalar, binding = BENCH_OUTPUT) writeonly buffer Output
{
    BenchResponse responses[];
};

void main()
{
    const uint i = gl_GlobalInvocationID.x;
    if (i >= params.count)
        return;
    const vec3 response = evaluateClassified(makeBenchReceiver(receivers[i]), i);
    responses[i] = BenchResponse(response.x, response.y, response.z);
}
