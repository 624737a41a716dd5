// SPDX-License-Identifier: Apache-2.0
// Computes the irradiance divided by pi for every normal, as a sum over all texels of one mip.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/environment.h"
#include "lib/cube.glsl"

layout(local_size_x = ENVIRONMENT_GROUP, local_size_y = ENVIRONMENT_GROUP) in;
layout(push_constant, scalar) uniform Push
{
    EnvironmentIrradianceParams params;
};
layout(binding = ENVIRONMENT_IRRADIANCE_SOURCE, rgba32f) uniform readonly image2DArray source;
layout(binding = ENVIRONMENT_IRRADIANCE_OUTPUT, rgba32f) uniform writeonly image2DArray irradiance;

void main()
{
    const uvec3 texel = gl_GlobalInvocationID;
    const vec2 centre = cubeTexelCentre(texel.xy, ENVIRONMENT_IRRADIANCE_SIZE);
    const vec3 n = normalize(cubeDirection(texel.z, centre));
    vec3 sum = vec3(0.0);
    float weight = 0.0;
    for (uint face = 0u; face < 6u; ++face)
        for (uint y = 0u; y < params.sourceSize; ++y) {
            vec3 rowSum = vec3(0.0);
            float rowWeight = 0.0;
            for (uint x = 0u; x < params.sourceSize; ++x) {
                const vec2 uv = cubeTexelCentre(uvec2(x, y), params.sourceSize);
                const vec3 d = cubeDirection(face, uv);
                // Cosine times solid angle: the solid angle contributes |d|^-3, the cosine |d|^-1.
                const float invD2 = 1.0 / dot(d, d);
                const float w = max(dot(n, d), 0.0) * invD2 * invD2;
                rowSum += w * imageLoad(source, ivec3(x, y, face)).rgb;
                rowWeight += w;
            }
            sum += rowSum;
            weight += rowWeight;
        }
    imageStore(irradiance, ivec3(texel), vec4(sum / weight, 1.0));
}
