// SPDX-License-Identifier: Apache-2.0
// Test-only: the specular methods of sphere lights, evaluated on given inputs.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/lighting.h"
#include "shared/probes.h"
#include "lib/gbuffer.glsl"
#include "lib/specular/conic.glsl"
#include "lib/specular/kx.glsl"

layout(local_size_x = PROBE_GROUP) in;
layout(push_constant, scalar) uniform Push
{
    ProbeParams params;
};
layout(scalar, binding = PROBE_INPUT) readonly buffer Input
{
    ConicProbeInput inputs[];
};
layout(scalar, binding = PROBE_OUTPUT) writeonly buffer Output
{
    ConicProbeOutput outputs[];
};

void main()
{
    const uint i = gl_GlobalInvocationID.x;
    if (i >= params.count)
        return;
    const ConicProbeInput probe = inputs[i];
    const vec3 n = vec3(0.0, 0.0, 1.0);
    const Surface surface = Surface(n, vec3(1.0), vec3(1.0), 1.0, sqrt(probe.alpha));
    const ShadingPoint p = makeShadingPoint(surface, vec3(0.0), probe.v);
    const ConicPoint conic = makeConicPoint(p);
    const SphereCap cap = makeSphereCap(n, probe.toLight, probe.radius);
    outputs[i].lightClass = conicClassOf(conic, cap);
    outputs[i].conic = conicResponse(conic, cap);
    outputs[i].full = conicFullResponse(conic, cap);
    outputs[i].kx = kxResponse(p, cap);
    outputs[i].point = pointResponse(p, cap);
}
