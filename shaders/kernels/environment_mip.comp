// SPDX-License-Identifier: Apache-2.0
// Computes one mip of a cube from the next finer one.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/environment.h"
#include "lib/cube.glsl"

layout(local_size_x = ENVIRONMENT_GROUP, local_size_y = ENVIRONMENT_GROUP) in;
layout(push_constant, scalar) uniform Push
{
    EnvironmentMipParams params;
};
layout(binding = ENVIRONMENT_MIP_INPUT, rgba32f) uniform readonly image2DArray finer;
layout(binding = ENVIRONMENT_MIP_OUTPUT, rgba32f) uniform writeonly image2DArray coarser;

void main()
{
    const uvec3 texel = gl_GlobalInvocationID;
    if (any(greaterThanEqual(texel.xy, uvec2(params.size))))
        return;
    vec3 sum = vec3(0.0);
    float weight = 0.0;
    for (uint i = 0u; i < 4u; ++i) {
        const uvec2 child = 2u * texel.xy + uvec2(i & 1u, i >> 1u);
        const float w =
            cubeTexelSolidAngle(cubeTexelCentre(child, 2u * params.size), 2u * params.size);
        sum += w * imageLoad(finer, ivec3(child, texel.z)).rgb;
        weight += w;
    }
    imageStore(coarser, ivec3(texel), vec4(sum / weight, 1.0));
}
