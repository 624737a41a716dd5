// SPDX-License-Identifier: Apache-2.0
// Outgoing luminance of one shaded point under one light. All lights of a dispatch are of one type,
// a specialisation constant. The includer provides lightCentre(), lightEmission() and lightAux[].
#ifndef CND_LIB_LIGHT_EVAL
#define CND_LIB_LIGHT_EVAL

#include "lib/lights/sphere.glsl"
#include "lib/specular/karis.glsl"

layout(constant_id = SPEC_SPECULAR_METHOD) const uint specularMethod = SPECULAR_CONIC;
layout(constant_id = SPEC_LIGHT_TYPE) const uint lightType = LIGHT_SPHERE;
layout(constant_id = SPEC_ERROR_BUDGET) const uint errorBudget = 0u;

const bool IS_DISTANT = lightType == LIGHT_DIRECTIONAL || lightType == LIGHT_DISTANT_SPHERE;
const bool IS_SPHERE = lightType == LIGHT_SPHERE || lightType == LIGHT_DISTANT_SPHERE;
const bool HAS_BUDGET = errorBudget != 0u;
const bool IS_CONIC = specularMethod == SPECULAR_CONIC || specularMethod == SPECULAR_CONIC_FULL;

// How a light is evaluated at a point; the cheapest form that is right there. Kernels keep the forms in
// separate loops: a branch inside one loop is paid by every light on some devices.
const uint EVALUATE_POINT = 0u;   // sphere whose size is within the error budget
const uint EVALUATE_ABOVE = 1u;   // sphere above the horizon
const uint EVALUATE_NEAR = 2u;    // sphere that nearly touches the horizon, or tiny across it
const uint EVALUATE_GENERAL = 3u; // sphere across the horizon; any light of other types

// What a pixel prepares once for all lights.
struct Receiver {
    ShadingPoint p;
    float pointLimit; // (R / d)^2 below which a sphere is evaluated as a point
};

Receiver makeReceiver(ShadingPoint p)
{
    Receiver r;
    r.p = p;
    r.pointLimit = 0.0;
    return r;
}

// (1 - (d / r)^4)^2 for d < r, else 0; 1 for infinite r. Lagarde and de Rousiers 2014, eq. 26.
float influenceWindow(float d2, float influenceRadius2)
{
    const float x = min(d2 / influenceRadius2, 1.0);
    const float w = 1.0 - x * x;
    return w * w;
}

// From the point to the light's centre; unit length for distant lights.
vec3 towardsLight(vec3 centre, vec3 position)
{
    return IS_DISTANT ? centre : centre - position;
}

// Whether a light can add anything: inside its influence, and not wholly below the horizon. `reach`:
// from its centre to its farthest point.
bool lightReaches(vec3 toLight, vec3 n, float reach, float influenceRadius2)
{
    return dot(toLight, toLight) < influenceRadius2 && dot(n, toLight) > -reach;
}

vec3 evaluateSphere(Receiver r, uint evaluation, vec3 toLight, float radius)
{
    const float d2 = length2(toLight);
    const float invD = inversesqrt(max(d2, MIN_LENGTH2));
    const float s = min(radius * invD, 1.0);
    const float s2 = s * s;
    const float c = dot(r.p.n, toLight) * invD;
    const bool above = evaluation == EVALUATE_POINT || evaluation == EVALUATE_ABOVE;
    vec3 response = r.p.albedo * (above ? c * s2 : sphereFormFactor(c, s2));
    if (specularMethod == SPECULAR_KARIS)
        response += schlick(r.p, karisResponse(r.p, toLight, invD, radius, s2));
    return response;
}

// Response to unit illuminance on a surface that faces the light, from the unit direction l.
vec3 evaluatePunctual(ShadingPoint p, vec3 l)
{
    vec3 response = p.albedo * (INV_PI * max(dot(p.n, l), 0.0));
    if (specularMethod != SPECULAR_NONE)
        response += schlick(p, specularResponse(p, l));
    return response;
}

// Response to unit intensity (point: the same everywhere; spot: on its axis).
vec3 evaluateIntensity(ShadingPoint p, uint light, vec3 toLight)
{
    const float d2 = max(length2(toLight), MIN_LENGTH2);
    const vec3 l = toLight * inversesqrt(d2);
    float illuminance = 1.0 / d2;
    if (lightType == LIGHT_SPOT) {
        // KHR_lights_punctual, "Inner and Outer Cone Angles".
        const vec3 axis = lightAux[light * LIGHT_AUX_STRIDE].xyz;
        const vec2 cone = lightAux[light * LIGHT_AUX_STRIDE + 1u].xy;
        const float t = saturate(dot(-l, axis) * cone.x + cone.y);
        illuminance *= t * t;
    }
    return illuminance * evaluatePunctual(p, l);
}

// Response to unit emission, without the influence window.
vec3 evaluateUnwindowed(Receiver r, uint evaluation, uint light, vec3 toLight, float reach)
{
    if (IS_SPHERE)
        return evaluateSphere(r, evaluation, toLight, reach);
    if (lightType == LIGHT_DIRECTIONAL)
        return evaluatePunctual(r.p, toLight);
    return evaluateIntensity(r.p, light, toLight);
}

vec3 evaluateLight(Receiver r, uint evaluation, uint light)
{
    const vec4 centreReach = lightCentre(light);
    const vec4 emissionInfluence = lightEmission(light);
    const vec3 toLight = towardsLight(centreReach.xyz, r.p.position);
    vec3 emission = emissionInfluence.xyz;
    if (!IS_DISTANT)
        emission *= influenceWindow(length2(toLight), emissionInfluence.w);
    return emission * evaluateUnwindowed(r, evaluation, light, toLight, centreReach.w);
}

#endif
