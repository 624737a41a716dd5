// SPDX-License-Identifier: Apache-2.0
// Computes one level of the prefiltered cube.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/environment.h"
#include "lib/cube.glsl"
#include "lib/ggx_sampling.glsl"

layout(local_size_x = ENVIRONMENT_GROUP, local_size_y = ENVIRONMENT_GROUP) in;
layout(push_constant, scalar) uniform Push
{
    EnvironmentPrefilterParams params;
};
layout(binding = ENVIRONMENT_PREFILTER_SOURCE) uniform samplerCube source;
layout(binding = ENVIRONMENT_PREFILTER_OUTPUT, rgba32f) uniform writeonly image2DArray prefiltered;

// Returns n as the third column and two unit vectors perpendicular to it and to each other (Duff et al.
// 2017, "Building an Orthonormal Basis, Revisited").
mat3 basisAround(vec3 n)
{
    const float s = n.z >= 0.0 ? 1.0 : -1.0;
    const float a = -1.0 / (s + n.z);
    const float b = n.x * n.y * a;
    return mat3(vec3(1.0 + s * n.x * n.x * a, s * b, -s * n.x), vec3(b, s + n.y * n.y * a, -n.y), n);
}

// Returns an element of the van der Corput sequence in base 2.
float radicalInverse(uint i)
{
    return float(bitfieldReverse(i)) * 2.3283064365386963e-10; // 2^-32
}

void main()
{
    const uvec3 texel = gl_GlobalInvocationID;
    if (any(greaterThanEqual(texel.xy, uvec2(params.size))))
        return;
    const vec3 n = normalize(cubeDirection(texel.z, cubeTexelCentre(texel.xy, params.size)));
    const mat3 basis = basisAround(n);
    const float a2 = params.alpha * params.alpha;
    const float texelSolidAngle = 4.0 * PI / (6.0 * float(params.sourceSize * params.sourceSize));
    vec3 sum = vec3(0.0);
    float weight = 0.0;
    for (uint i = 0u; i < ENVIRONMENT_PREFILTER_SAMPLES; ++i) {
        // The microfacet normals have the density D NoH (Walter et al. 2007, eq. 35). v = n, so
        // VoH = NoH.
        const float u = (float(i) + 0.5) / float(ENVIRONMENT_PREFILTER_SAMPLES);
        const float phi = 2.0 * PI * radicalInverse(i);
        const float c2 = (1.0 - u) / (1.0 + (a2 - 1.0) * u);
        const float NoL = 2.0 * c2 - 1.0;
        if (NoL > 0.0) {
            const float sine = 2.0 * sqrt(max(1.0 - c2, 0.0) * c2);
            const vec3 l = basis * vec3(sine * cos(phi), sine * sin(phi), NoL);
            const float width = c2 * (a2 - 1.0) + 1.0;
            const float pdf = a2 * INV_PI / (4.0 * width * width); // D NoH / (4 VoH)
            const float share = 1.0 / (pdf * float(ENVIRONMENT_PREFILTER_SAMPLES));
            const float mip = max(0.5 * log2(share / texelSolidAngle) + 1.0, 0.0);
            // BRDF NoL / pdf = G2 / NoV = 1 / (1 + Lambda(l)), since Lambda(v) = 0.
            const float w = 1.0 / (1.0 + smithLambda(NoL, params.alpha));
            sum += w * textureLod(source, l, mip).rgb;
            weight += w;
        }
    }
    imageStore(prefiltered, ivec3(texel), vec4(sum / weight, 1.0));
}
