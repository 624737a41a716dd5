// SPDX-License-Identifier: Apache-2.0
// Fills the table of the specular lobe's directional albedo.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/dfg.h"
#include "lib/dfg_axes.glsl"
#include "lib/ggx_sampling.glsl"

layout(local_size_x = DFG_TABLE_GROUP) in;
layout(push_constant, scalar) uniform Push
{
    DfgTableParams params;
};
layout(scalar, binding = DFG_TABLE_ENTRIES) writeonly buffer Entries
{
    vec2 entries[]; // two vec2 per entry of the table
};

// Returns the share of a uniform white environment's light that the lobe reflects towards
// v = (sqrt(1 - NoV^2), 0, NoV): the mean over visible normals of G2 / G1 (Heitz 2018, eq. 19), without
// and with the factor (1 - VoH)^5.
vec2 directionalAlbedo(float NoV, float alpha)
{
    const vec3 v = vec3(sqrt(max(1.0 - NoV * NoV, 0.0)), 0.0, NoV);
    const float lambdaV = smithLambda(NoV, alpha);
    vec2 sum = vec2(0.0);
    for (uint ring = 0u; ring < DFG_RINGS; ++ring) {
        const float w = (float(ring) + 0.5) / float(DFG_RINGS);
        vec2 ringSum = vec2(0.0);
        for (uint spoke = 0u; spoke < DFG_SPOKES; ++spoke) {
            const float phi = PI * (float(spoke) + 0.5) / float(DFG_SPOKES);
            const vec3 h = visibleNormal(v, alpha, phi, 1.0 - w * w * w);
            const float VoH = saturate(dot(v, h));
            const float NoL = 2.0 * VoH * h.z - NoV;
            if (NoL > 0.0) {
                const float lambdaL = smithLambda(NoL, alpha);
                const float g = (1.0 + lambdaV) / (1.0 + lambdaV + lambdaL);
                ringSum += vec2(g, g * pow5(1.0 - VoH));
            }
        }
        sum += 3.0 * w * w * ringSum;
    }
    return sum / float(DFG_RINGS * DFG_SPOKES);
}

void main()
{
    const uint i = gl_GlobalInvocationID.x;
    if (i >= params.entryCount)
        return;
    const uint column = i % DFG_SIZE;
    const vec2 albedo = directionalAlbedo(dfgNoV(column), dfgAlpha(i / DFG_SIZE));
    entries[2u * i] = albedo;
    if (column > 0u)
        entries[2u * i - 1u] = albedo;
    if (column == DFG_SIZE - 1u)
        entries[2u * i + 1u] = albedo;
}
