// SPDX-License-Identifier: Apache-2.0
// Test-only: the specular response to sphere lights by the specialised method, as shading evaluates it.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/bench.h"
#include "shared/lighting_data.h"
#include "shared/probes.h"
#include "lib/brdf.glsl"
#include "lib/surface.glsl"

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

LightShape lightShapes[1]; // spheres have none

vec4 lightCentre(uint light)
{
    return vec4(inputs[light].toLight, inputs[light].radius);
}

vec4 lightEmission(uint light)
{
    return vec4(1.0, 1.0, 1.0, UNBOUNDED * UNBOUNDED);
}

uint lightAt(uint k)
{
    return k;
}

#include "bench/evaluate_classified.glsl"

void main()
{
    const uint i = gl_GlobalInvocationID.x;
    if (i >= params.count)
        return;
    const vec3 n = vec3(0.0, 0.0, 1.0);
    const Surface surface = Surface(n, vec3(0.0), vec3(0.0), 1.0, sqrt(inputs[i].alpha));
    ShadingPoint p = makeShadingPoint(surface, vec3(0.0), inputs[i].v);
    separateLobes(p);
    const Receiver r = makeReceiver(p, 1u, 0u);
    outputs[i] = ConicProbeOutput(wayOf(r, i), evaluateClassified(r, i).yz);
}
