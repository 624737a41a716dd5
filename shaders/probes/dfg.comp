// SPDX-License-Identifier: Apache-2.0
// Test-only: lookup of the directional albedo, and the lobes joined with it.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/dfg_probe.h"
#include "lib/dfg.glsl"
#include "lib/gbuffer.glsl"
#include "lib/joining.glsl"

layout(local_size_x = PROBE_GROUP) in;
layout(push_constant, scalar) uniform Push
{
    ProbeParams params;
};
layout(scalar, binding = PROBE_INPUT) readonly buffer Input
{
    DfgProbeInput inputs[];
};
layout(scalar, binding = PROBE_OUTPUT) writeonly buffer Output
{
    DfgProbeOutput outputs[];
};
layout(binding = PROBE_TABLE) uniform textureBuffer dfgTexels;

// The table of lib/dfg.glsl.
vec4 dfgTexel(int entry)
{
    return texelFetch(dfgTexels, entry);
}

void main()
{
    const uint i = gl_GlobalInvocationID.x;
    if (i >= params.count)
        return;
    const DfgProbeInput probe = inputs[i];
    const vec3 v = vec3(sqrt(max(1.0 - probe.NoV * probe.NoV, 0.0)), 0.0, probe.NoV);
    const Surface surface = Surface(vec3(0.0, 0.0, 1.0), vec3(probe.albedo), vec3(probe.F0),
                                    probe.F90, sqrt(probe.alpha));
    ShadingPoint p = makeShadingPoint(surface, vec3(0.0), v);
    const vec2 albedo = directionalAlbedo(p.NoV, p.alpha);
    joinLobes(p, albedo, probe.joining, probe.energyCompensation);
    outputs[i] = DfgProbeOutput(albedo, p.albedo.x, p.F0.x, p.F90.x);
}
