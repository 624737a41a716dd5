// SPDX-License-Identifier: Apache-2.0
// Outgoing luminance of one shaded point under one light of any type. The includer provides lightAux.
#ifndef CND_LIB_LIGHT_EVAL
#define CND_LIB_LIGHT_EVAL

#include "lib/lights/sphere.glsl"
#include "lib/specular/karis.glsl"

layout(constant_id = SPEC_SPECULAR_METHOD) const uint specularMethod = SPECULAR_KARIS;
layout(constant_id = SPEC_ONLY_SPHERES) const uint onlySpheres = 0u;

// (1 - (d / r)^4)^2 for d < r, else 0; 1 for infinite r. Lagarde and de Rousiers 2014, eq. 26.
float influenceWindow(float d2, float influenceRadius2)
{
    const float x = min(d2 / influenceRadius2, 1.0);
    const float w = 1.0 - x * x;
    return w * w;
}

// Whether a light can add anything: inside its influence, and not wholly below the horizon.
bool lightReaches(vec3 position, vec3 n, vec4 centreRadius, float influenceRadius2)
{
    const vec3 toLight = centreRadius.xyz - position;
    return dot(toLight, toLight) < influenceRadius2 && dot(n, toLight) > -centreRadius.w;
}

vec3 evaluateSphere(ShadingPoint p, vec3 toLight, float radius, vec3 luminance)
{
    const float d2 = length2(toLight);
    const float invD = inversesqrt(max(d2, MIN_LENGTH2));
    const float s = min(radius * invD, 1.0);
    const float s2 = s * s;
    vec3 response = p.albedo * sphereFormFactor(dot(p.n, toLight) * invD, s2);
    if (specularMethod == SPECULAR_KARIS)
        response += schlick(p, karisResponse(p, toLight, invD, radius, s2));
    return luminance * response;
}

// `illuminance` on a surface that faces the light, from the unit direction l.
vec3 evaluatePunctual(ShadingPoint p, vec3 l, vec3 illuminance)
{
    vec3 response = p.albedo * (INV_PI * max(dot(p.n, l), 0.0));
    if (specularMethod != SPECULAR_NONE)
        response += schlick(p, specularResponse(p, l));
    return illuminance * response;
}

// Without the influence window.
vec3 evaluateUnwindowed(ShadingPoint p, uint light, vec3 toLight, float radius, vec3 emission)
{
    if (onlySpheres != 0u)
        return evaluateSphere(p, toLight, radius, emission);
    const vec4 aux = lightAux[light * LIGHT_AUX_STRIDE];
    const uint type = uint(aux.w);
    if (type == LIGHT_SPHERE)
        return evaluateSphere(p, toLight, radius, emission);
    if (type == LIGHT_DIRECTIONAL)
        return evaluatePunctual(p, -aux.xyz, emission);
    const float d2 = max(length2(toLight), MIN_LENGTH2);
    const vec3 l = toLight * inversesqrt(d2);
    vec3 illuminance = emission / d2;
    if (type == LIGHT_SPOT) {
        // KHR_lights_punctual, "Inner and Outer Cone Angles".
        const vec4 cone = lightAux[light * LIGHT_AUX_STRIDE + 1u];
        const float t = saturate(dot(-l, aux.xyz) * cone.x + cone.y);
        illuminance *= t * t;
    }
    return evaluatePunctual(p, l, illuminance);
}

vec3 evaluateLight(ShadingPoint p, uint light, vec4 centreRadius, vec4 emissionInfluence)
{
    const vec3 toLight = centreRadius.xyz - p.position;
    const float window = influenceWindow(length2(toLight), emissionInfluence.w);
    return window * evaluateUnwindowed(p, light, toLight, centreRadius.w, emissionInfluence.xyz);
}

#endif
