// SPDX-License-Identifier: Apache-2.0
// Outgoing luminance of one shaded point under one light. All lights of a dispatch are of one type,
// a specialisation constant. The includer provides lightCentre(), lightEmission() and lightAux[].
#ifndef CND_LIB_LIGHT_EVAL
#define CND_LIB_LIGHT_EVAL

#include "lib/lights/sphere.glsl"
#include "lib/specular/conic.glsl"
#include "lib/specular/karis.glsl"
#include "lib/specular/kx.glsl"

layout(constant_id = SPEC_SPECULAR_METHOD) const uint specularMethod = SPECULAR_CONIC;
layout(constant_id = SPEC_LIGHT_TYPE) const uint lightType = LIGHT_SPHERE;
layout(constant_id = SPEC_ERROR_BUDGET) const uint errorBudget = 0u;

const bool IS_DISTANT = lightType == LIGHT_DIRECTIONAL || lightType == LIGHT_DISTANT_SPHERE;
const bool IS_SPHERE = lightType == LIGHT_SPHERE || lightType == LIGHT_DISTANT_SPHERE;
const bool HAS_BUDGET = errorBudget != 0u;
const bool IS_CONIC = specularMethod == SPECULAR_CONIC || specularMethod == SPECULAR_CONIC_FULL;

// How a light is evaluated at a point; the cheapest form that is right there. Kernels keep the forms
// in separate loops: a branch inside one loop is paid by every light on some devices.
const uint EVALUATE_POINT = 0u;   // sphere whose size is within the error budget
const uint EVALUATE_ABOVE = 1u;   // sphere above the horizon
const uint EVALUATE_NEAR = 2u;    // sphere that nearly touches the horizon, or tiny across it
const uint EVALUATE_GENERAL = 3u; // sphere across the horizon; any light of other types

// The bound of the error of a point is not proven for errors of the specular lobe beyond this.
const float MAX_POINT_ERROR = 0.3;

// What a pixel prepares once for all lights.
struct Receiver {
    ShadingPoint p;
    ConicPoint conic;
    float pointLimit; // (R / d)^2 up to which a sphere above the horizon is evaluated as a point
};

// Largest (R / d)^2 whose evaluation as a point errs by at most `budget` of the highest response.
// The error is below 2 q of the specular peak, q = (s^2 / 8 alpha^2) (1 + 1 / NoV^2): measured; a
// point has L1 L2 where the peak is L1 L2 / sqrt((1 + L1^2) (1 + L2^2)), L1 = s / 2 alpha, L2 = L1 / NoV.
// The diffuse part is exact either way, so the budget grows by what it adds to the response: a
// specular peak of F s^2 / (4 alpha^2 NoV) against albedo s^2.
float pointLimit(ShadingPoint p, float budget)
{
    const vec3 F = mix(p.F0, vec3(p.F90), pow5(1.0 - p.NoV));
    const float F1 = max(max(F.x, F.y), max(F.z, 1e-6));
    const float albedo = min(p.albedo.x, min(p.albedo.y, p.albedo.z));
    const float a2 = p.alpha * p.alpha;
    const float share = budget * (1.0 + 4.0 * a2 * p.NoV * albedo / F1);
    return min(share, MAX_POINT_ERROR) * 4.0 * a2 / (1.0 + 1.0 / (p.NoV * p.NoV));
}

Receiver makeReceiver(ShadingPoint p, float budget)
{
    Receiver r;
    r.p = p;
    if (IS_SPHERE && IS_CONIC)
        r.conic = makeConicPoint(p);
    r.pointLimit = HAS_BUDGET ? pointLimit(p, budget) : 0.0;
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

// Response of the specular lobe to a sphere of unit luminance.
vec2 sphereSpecular(Receiver r, uint evaluation, SphereCap cap, vec3 toLight, float radius)
{
    if (evaluation == EVALUATE_POINT || specularMethod == SPECULAR_POINT)
        return pointResponse(r.p, cap);
    if (specularMethod == SPECULAR_KX)
        return kxResponse(r.p, cap);
    if (specularMethod == SPECULAR_KARIS)
        return karisResponse(r.p, toLight, inversesqrt(max(length2(toLight), MIN_LENGTH2)), radius,
                             cap.s2);
    if (evaluation == EVALUATE_GENERAL) // a receiver inside a sphere may have its cap below
        return cap.NoC > -cap.s ? conicClipped(r.conic, cap) : vec2(0.0);
    if (specularMethod == SPECULAR_CONIC_FULL)
        return conicFullUnclipped(r.conic, cap);
    return evaluation == EVALUATE_NEAR ? conicNear(r.conic, cap) : conicAbove(r.conic, cap);
}

vec3 evaluateSphere(Receiver r, uint evaluation, vec3 toLight, float radius)
{
    const SphereCap cap = makeSphereCap(r.p.n, toLight, radius);
    const bool above = evaluation == EVALUATE_POINT || evaluation == EVALUATE_ABOVE;
    vec3 response = r.p.albedo * (above ? cap.NoC * cap.s2 : sphereFormFactor(cap.NoC, cap.s2));
    if (specularMethod != SPECULAR_NONE)
        response += schlick(r.p, sphereSpecular(r, evaluation, cap, toLight, radius));
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
