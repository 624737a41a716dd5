// SPDX-License-Identifier: Apache-2.0
// Computes one mip of a cube from the next finer one.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/environment_data.h"
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
    // A child gives 3/4 to its parent and 1/4 to the parent on its other side, which keeps its
    // place on the face. At the edge of a face the one parent gets both.
    const float shares[4] = float[4](0.25, 0.75, 0.75, 0.25);
    vec3 sum = vec3(0.0);
    float weight = 0.0;
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 4; ++x) {
            const ivec2 child =
                clamp(2 * ivec2(texel.xy) + ivec2(x, y) - 1, ivec2(0), ivec2(2u * params.size) - 1);
            const vec2 centre = cubeTexelCentre(uvec2(child), 2u * params.size);
            const float w = shares[x] * shares[y] * cubeTexelSolidAngle(centre, 2u * params.size);
            sum += w * imageLoad(finer, ivec3(child, texel.z)).rgb;
            weight += w;
        }
    imageStore(coarser, ivec3(texel), vec4(sum / weight, 1.0));
}
