// SPDX-License-Identifier: Apache-2.0
// Test-only: diffuse and specular response of the area lights, and transformed cosines of spheres.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/area_probe.h"
#include "shared/light_types.h"
#include "shared/lighting.h"
layout(scalar, binding = AREA_PROBE_TABLE) readonly buffer Table
{
    vec4 texels[];
};
vec4 ltcTexel(uint index)
{
    return texels[index];
}
#include "lib/gbuffer.glsl"
#include "lib/lights/disc.glsl"
#include "lib/lights/sphere_cap.glsl"
#include "lib/specular/ltc.glsl"
#include "lib/specular/representative.glsl"
#include "lib/specular/sampled.glsl"

layout(local_size_x = PROBE_GROUP) in;
layout(push_constant, scalar) uniform Push
{
    ProbeParams params;
};
layout(scalar, binding = PROBE_INPUT) readonly buffer Input
{
    AreaProbeInput inputs[];
};
layout(scalar, binding = PROBE_OUTPUT) writeonly buffer Output
{
    AreaProbeOutput outputs[];
};

void main()
{
    const uint i = gl_GlobalInvocationID.x;
    if (i >= params.count)
        return;
    const AreaProbeInput light = inputs[i];
    const vec3 n = vec3(0.0, 0.0, 1.0);
    const Surface surface = Surface(n, vec3(1.0), vec3(1.0), 1.0, sqrt(light.alpha));
    const ShadingPoint p = makeShadingPoint(surface, vec3(0.0), light.v);
    const LtcPoint q = makeLtcPoint(p);
    const bool twoSided = light.twoSided != 0u;
    AreaProbeOutput result = AreaProbeOutput(0.0, vec2(0.0), vec2(0.0), vec2(0.0));
    if (light.type == LIGHT_SPHERE) {
        const SphereCap cap = makeSphereCap(n, light.toCentre, light.radius);
        result.formFactor = sphereFormFactor(cap.NoC, cap.s2);
        result.ltc = ltcSphere(q, cap.c, cap.s2);
        result.sampled = sampledSphere(p, cap.c, cap.omc, AREA_PROBE_SAMPLES, light.seed);
    } else if (light.type == LIGHT_TUBE) {
        const TubeOutline tube = makeTubeOutline(light.toCentre, light.axisU, light.radius);
        result.formFactor = tubeFormFactor(n, tube);
        result.ltc = ltcTube(q, tube);
        result.representative = representativeTube(p, light.toCentre, light.axisU, light.radius);
        result.sampled =
            sampledTube(p, light.toCentre, light.axisU, light.radius, AREA_PROBE_SAMPLES, light.seed);
    } else if (light.type == LIGHT_RECTANGLE) {
        result.formFactor = rectangleFormFactor(n, light.toCentre, light.axisU, light.axisV, twoSided);
        result.ltc = ltcRectangle(q, light.toCentre, light.axisU, light.axisV, twoSided);
        result.representative =
            representativeRectangle(p, light.toCentre, light.axisU, light.axisV, twoSided);
        result.sampled = sampledRectangle(p, light.toCentre, light.axisU, light.axisV, twoSided,
                                          AREA_PROBE_SAMPLES, light.seed);
    } else if (light.type == LIGHT_DISC) {
        result.formFactor = discFormFactor(n, light.toCentre, light.axisU, light.radius, twoSided);
        result.ltc = ltcDisc(q, light.toCentre, light.axisU, light.radius, twoSided);
        result.representative =
            representativeDisc(p, light.toCentre, light.axisU, light.radius, twoSided);
        result.sampled = sampledDisc(p, light.toCentre, light.axisU, light.radius, twoSided,
                                     AREA_PROBE_SAMPLES, light.seed);
    }
    outputs[i] = result;
}
