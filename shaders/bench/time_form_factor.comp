// SPDX-License-Identifier: Apache-2.0
// Times the diffuse form factor of a sphere: the shipping form against the usual one.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "bench/bench_lights.glsl"

layout(local_size_x = BENCH_GROUP) in;
layout(constant_id = SPEC_BENCH_FORM_FACTOR) const uint form = BENCH_FORM_FACTOR_NONE;
layout(scalar, binding = BENCH_INPUT) readonly buffer Input
{
    BenchReceiver receivers[];
};
layout(scalar, binding = BENCH_OUTPUT) writeonly buffer Output
{
    float sums[];
};

// The usual form of Lagarde and de Rousiers 2014, section 4.7.2, with one acos and one atan, divided by
// pi. In single precision it loses small lights and returns NaN where the light touches the horizon.
float naiveFormFactor(float c, float s2)
{
    const float sine = sqrt(1.0 - c * c);
    const float x = sqrt(1.0 / s2 - 1.0);
    const float y = -x * (c / sine);
    const float sineRootY = sine * sqrt(1.0 - y * y);
    const float crossing = INV_PI * ((c * acos(y) - x * sineRootY) * s2 + atan(sineRootY / x));
    return c * c > s2 ? s2 * saturate(c) : crossing;
}

void main()
{
    const uint i = gl_GlobalInvocationID.x;
    if (i >= params.count)
        return;
    const vec3 n = receivers[i].n;
    float sum = 0.0;
    for (uint light = 0u; light < params.lightCount; ++light) {
        const vec4 centreRadius = lightCentre(light);
        const float invD2 = 1.0 / max(length2(centreRadius.xyz), MIN_LENGTH2);
        const float c = dot(n, centreRadius.xyz) * sqrt(invD2);
        const float s2 = min(centreRadius.w * centreRadius.w * invD2, 1.0);
        if (form == BENCH_FORM_FACTOR_ROBUST)
            sum += sphereFormFactor(c, s2);
        else if (form == BENCH_FORM_FACTOR_NAIVE)
            sum += naiveFormFactor(c, s2);
        else
            sum += c * s2;
    }
    sums[i] = sum;
}
