// SPDX-License-Identifier: Apache-2.0
// Computes one level of the prefiltered cube.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/environment_data.h"
#include "lib/cube.glsl"

layout(local_size_x = ENVIRONMENT_GROUP, local_size_y = ENVIRONMENT_GROUP) in;
layout(push_constant, scalar) uniform Push
{
    EnvironmentPrefilterParams params;
};
layout(binding = ENVIRONMENT_PREFILTER_SOURCE) uniform samplerCube source;
layout(binding = ENVIRONMENT_PREFILTER_OUTPUT, rgba32f) uniform writeonly image2DArray prefiltered;
layout(scalar, binding = ENVIRONMENT_PREFILTER_SAMPLES) readonly buffer Samples
{
    vec4 samples[];
};

// Returns n as the third column and two unit vectors perpendicular to it and to each other (Duff et
// al. 2017, "Building an Orthonormal Basis, Revisited").
mat3 basisAround(vec3 n)
{
    const float s = n.z >= 0.0 ? 1.0 : -1.0;
    const float a = -1.0 / (s + n.z);
    const float b = n.x * n.y * a;
    return mat3(vec3(1.0 + s * n.x * n.x * a, s * b, -s * n.x), vec3(b, s + n.y * n.y * a, -n.y),
                n);
}

void main()
{
    const uvec3 texel = gl_GlobalInvocationID;
    if (any(greaterThanEqual(texel.xy, uvec2(params.size))))
        return;
    const mat3 basis =
        basisAround(normalize(cubeDirection(texel.z, cubeTexelCentre(texel.xy, params.size))));
    vec3 sum = vec3(0.0);
    for (uint i = 0u; i < ENVIRONMENT_SAMPLES; ++i) {
        const vec4 at = samples[params.firstSample + i];
        const vec3 l = basis * vec3(at.xy, sqrt(1.0 - dot(at.xy, at.xy)));
        sum += at.w * textureLod(source, l, at.z).rgb;
    }
    imageStore(prefiltered, ivec3(texel), vec4(sum, 1.0));
}
