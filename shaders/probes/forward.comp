// SPDX-License-Identifier: Apache-2.0
// Test-only: evaluates lib/forward.glsl at the surfaces of a G-buffer, as a host's shader would.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/forward_probe.h"
#define FORWARD_SET FORWARD_PROBE_SET
#define CANDELABRA_VISIBILITY
#include "lib/forward.glsl"

layout(local_size_x = FORWARD_PROBE_GROUP) in;
layout(push_constant, scalar) uniform Push
{
    ForwardProbeParams params;
};
float candelabraVisibility(ShadowQuery query)
{
    return (query.light & params.shadowed) != 0u ? 0.5 : 1.0;
}

#ifdef CANDELABRA_VISIBLE_POINTS
// Any points, but others of each light.
uvec2 candelabraVisiblePoints(VisibilityQuery query)
{
    return uvec2(0x9E3779B9u, 0x85EBCA6Bu) * (query.light + 1u);
}
#endif

layout(binding = FORWARD_PROBE_NORMAL_ROUGHNESS) uniform utexture2D normalRoughnessImage;
layout(binding = FORWARD_PROBE_ALBEDO) uniform utexture2D albedoImage;
layout(binding = FORWARD_PROBE_SPECULAR) uniform utexture2D specularImage;
layout(binding = FORWARD_PROBE_DEPTH) uniform texture2D depthImage;
layout(scalar, binding = FORWARD_PROBE_OUTPUT) writeonly buffer Outputs
{
    ForwardProbeOutput outputs[];
};

void main()
{
    const uint i = gl_GlobalInvocationID.x;
    if (i >= params.size.x * params.size.y)
        return;
    const ivec2 pixel = ivec2(i % params.size.x, i / params.size.x);
    const float depth = texelFetch(depthImage, pixel, 0).x;
    outputs[i] = ForwardProbeOutput(vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0));
    if (depth == params.clearDepth)
        return;
    const Surface surface =
        unpackGBufferFull(texelFetch(normalRoughnessImage, pixel, 0).xy,
                          texelFetch(albedoImage, pixel, 0).xy,
                          texelFetch(specularImage, pixel, 0).xy);
    const vec3 position =
        viewPosition(forwardView.projection, uvec2(pixel), params.invImageSize, depth);
    outputs[i].lit = vec4(litSurface(surface, position), 1.0);
// llvmpipe takes 20 s to compile the walk in each of these functions.
#if !defined(CANDELABRA_SHADOWS) && !defined(CANDELABRA_VISIBLE_POINTS)
    const Receiver receiver = forwardReceiver(surface, position);
    vec3 stepped = vec3(0.0), illuminance = vec3(0.0), illuminanceBy = vec3(0.0);
    for (uint type = 0u; type < LIGHT_TYPE_COUNT; ++type) {
        LightCursor cursor = lightsAt(type, position);
        while (nextLight(cursor)) {
            vec3 direction;
            const vec3 e = illuminanceTowards(cursor.light, position, direction);
            stepped += evaluateLight(receiver, cursor.light);
            illuminance += e;
            illuminanceBy += e * direction;
        }
    }
    outputs[i].stepped = vec4(stepped, 1.0);
    outputs[i].illuminance = vec4(illuminance, 1.0);
    outputs[i].illuminanceBy = vec4(illuminanceBy, 1.0);
#endif
}
