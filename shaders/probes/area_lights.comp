// SPDX-License-Identifier: Apache-2.0
// Test-only: diffuse and specular response of the area lights.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/area_probe.h"
#include "shared/bench.h"
#include "shared/light_type_list.h"
#include "shared/lighting_data.h"
#include "lib/brdf.glsl"
#include "lib/lights/sphere.glsl"
#include "lib/lights/sphere_cap.glsl"
#include "lib/outline/disc.glsl"
#include "lib/outline/rectangle.glsl"
#include "lib/outline/tube.glsl"
#include "lib/specular/representative.glsl"
#include "lib/specular/sampled.glsl"
#include "lib/surface.glsl"

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

// The sphere that shading evaluates, as light 0.
vec4 sphere;
LightShape lightShapes[1]; // spheres have none

vec4 lightCentre(uint light)
{
    return sphere;
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

// Returns the light scaled to a distance of about 1, as shading does (shading/light.glsl).
AreaProbeInput atUnitDistance(AreaProbeInput light)
{
    const bool isDisc = light.type == LIGHT_DISC;
    const float reach = light.radius + (isDisc ? 0.0 : length(light.axisU) + length(light.axisV));
    const float scale = inversesqrt(max(length2(light.toCentre) + reach * reach, MIN_LENGTH2));
    light.toCentre *= scale;
    light.axisU *= isDisc ? 1.0 : scale;
    light.axisV *= scale;
    light.radius *= scale;
    return light;
}

WalkedOutline walked(ConicPoint p, AreaProbeInput light, bool lobe)
{
    const OutlineNeeds needs = OutlineNeeds(true, lobe, lobe, false);
    const OutlineFrame f = makeOutlineFrame(p);
    const bool twoSided = light.twoSided != 0u;
    if (light.type == LIGHT_TUBE)
        return tubeOutline(p, f, light.toCentre, light.axisU, light.radius, needs);
    if (light.type == LIGHT_RECTANGLE)
        return rectangleOutline(p, f, light.toCentre, light.axisU, light.axisV, twoSided, needs);
    return discOutline(p, f, light.toCentre, light.axisU, light.radius, twoSided, needs);
}

LightResponse byOutline(ConicPoint p, AreaProbeInput light, bool lobe)
{
    return outlineResponse(p, walked(p, light, lobe));
}

void main()
{
    const uint i = gl_GlobalInvocationID.x;
    if (i >= params.count)
        return;
    const AreaProbeInput light = atUnitDistance(inputs[i]);
    const vec3 n = vec3(0.0, 0.0, 1.0);
    const Surface surface = Surface(n, vec3(1.0), vec3(1.0), 1.0, sqrt(light.alpha));
    const ShadingPoint p = makeShadingPoint(surface, vec3(0.0), light.v);
    const ConicPoint conic = makeConicPoint(p);
    const bool twoSided = light.twoSided != 0u;
    AreaProbeOutput result = AreaProbeOutput(0.0, 0.0, vec2(0.0), vec2(0.0), vec2(0.0));
    if (light.type == LIGHT_SPHERE) {
        const SphereCap cap = makeSphereCap(n, light.toCentre, light.radius);
        ShadingPoint separate = p;
        separateLobes(separate);
        sphere = vec4(light.toCentre, light.radius);
        const vec3 response = evaluateClassified(makeReceiver(separate, 1u, 0u), 0u);
        result.formFactor = response.x;
        result.formFactorAlone = sphereFormFactor(cap.NoC, cap.s2);
        result.conic = response.yz;
        result.sampled = sampledSphere(p, cap.c, cap.omc, AREA_PROBE_SAMPLES, light.seed);
    } else {
        const LightResponse o = byOutline(conic, light, true);
        result.formFactor = o.formFactor;
        result.formFactorAlone = byOutline(conic, light, false).formFactor;
        result.conic = o.specular;
    }
    if (light.type == LIGHT_TUBE) {
        result.representative = representativeTube(p, light.toCentre, light.axisU, light.radius);
        result.sampled =
            sampledTube(p, light.toCentre, light.axisU, light.radius, AREA_PROBE_SAMPLES, light.seed);
    } else if (light.type == LIGHT_RECTANGLE) {
        result.representative =
            representativeRectangle(p, light.toCentre, light.axisU, light.axisV, twoSided);
        result.sampled = sampledRectangle(p, light.toCentre, light.axisU, light.axisV, twoSided,
                                          AREA_PROBE_SAMPLES, light.seed);
    } else if (light.type == LIGHT_DISC) {
        result.representative =
            representativeDisc(p, light.toCentre, light.axisU, light.radius, twoSided);
        result.sampled = sampledDisc(p, light.toCentre, light.axisU, light.radius, twoSided,
                                     AREA_PROBE_SAMPLES, light.seed);
    }
    outputs[i] = result;
}
