// SPDX-License-Identifier: Apache-2.0
// Test-only: packs and unpacks both G-buffer layouts.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/gbuffer_probe.h"
#include "lib/gbuffer.glsl"

layout(local_size_x = PROBE_GROUP) in;
layout(push_constant, scalar) uniform Push
{
    ProbeParams params;
};
layout(scalar, binding = PROBE_INPUT) readonly buffer Input
{
    PackingProbeInput inputs[];
};
layout(scalar, binding = PROBE_OUTPUT) writeonly buffer Output
{
    PackingProbeOutput outputs[];
};

float largest(vec3 v)
{
    return max(v.x, max(v.y, v.z));
}

void main()
{
    const uint i = gl_GlobalInvocationID.x;
    if (i >= params.count)
        return;
    const PackingProbeInput probe = inputs[i];
    const uvec2 normalRoughness = packNormalRoughnessFull(probe.normal, probe.perceptualRoughness);
    const uvec2 albedo = packAlbedoFull(probe.albedo);
    const uvec2 specular = packSpecularFull(probe.F0, probe.specularWeight);
    const Surface full = unpackGBufferFull(normalRoughness, albedo, specular);
    const Surface compact = unpackGBufferCompact(
        packNormalRoughnessCompact(probe.normal, probe.perceptualRoughness), vec4(0));
    const Surface unlit = unpackGBufferCompact(NORMAL_ROUGHNESS_UNLIT_COMPACT, vec4(1));
    outputs[i] = PackingProbeOutput(
        normalRoughness, albedo, specular, full.normal, full.perceptualRoughness, full.albedo,
        full.specularWeight, full.F0, compact.normal, compact.perceptualRoughness,
        vec3(largest(unlit.albedo), largest(unlit.F0), unlit.specularWeight));
}
