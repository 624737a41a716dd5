// SPDX-License-Identifier: Apache-2.0
// Test-only: the shipping functions of sphere lights, evaluated on given inputs.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/lighting_data.h"
#include "shared/probes.h"
#include "lib/gbuffer.glsl"
#include "lib/lights/sphere.glsl"
#include "lib/specular/karis.glsl"

layout(local_size_x = PROBE_GROUP) in;
layout(push_constant, scalar) uniform Push
{
    ProbeParams params;
};
layout(scalar, binding = PROBE_INPUT) readonly buffer Input
{
    SphereProbeInput inputs[];
};
layout(scalar, binding = PROBE_OUTPUT) writeonly buffer Output
{
    SphereProbeOutput outputs[];
};

void main()
{
    const uint i = gl_GlobalInvocationID.x;
    if (i >= params.count)
        return;
    const SphereProbeInput probe = inputs[i];
    const Surface surface = Surface(probe.n, vec3(1.0), vec3(1.0), 1.0, sqrt(probe.alpha));
    const ShadingPoint p = makeShadingPoint(surface, vec3(0.0), probe.v);
    const float invD = inversesqrt(max(length2(probe.centre), MIN_LENGTH2));
    const float s = min(probe.radius * invD, 1.0);
    const vec2 specular = karisResponse(p, probe.centre, invD, probe.radius, s * s);
    outputs[i] = SphereProbeOutput(sphereFormFactor(probe.c, probe.s2), specular.x, specular.y);
}
