// SPDX-License-Identifier: Apache-2.0
// A light as a receiver sees it. The includer provides lightCentre() and lightEmission().
#ifndef CND_SHADING_LIGHT
#define CND_SHADING_LIGHT

#include "lib/light_shape.glsl"
#include "lib/specular/sampled.glsl"
#include "shading/light_type.glsl"
#include "shading/receiver.glsl"
#include "shading/shadow_term.glsl"

// Returns (1 - (d / r)^4)^2 for d < r, else 0; 1 if r is UNBOUNDED (Lagarde and de Rousiers 2014,
// eq. 26).
float influenceWindow(float d2, float influenceRadius2)
{
    // If r is UNBOUNDED, x * x would underflow without the lower limit. CPUs take a hundred cycles for
    // that. The limit changes no result.
    const float x = clamp(d2 / influenceRadius2, 1e-12, 1.0);
    const float w = 1.0 - x * x;
    return w * w;
}

// A light relative to a point.
struct Light {
    uint index;
    vec3 toLight; // from the point to the centre; distant lights: unit direction
    float boundingRadius; // radius of a sphere around the centre that holds the emitter
};

Light readLight(Receiver r, uint index)
{
    const vec4 centreRadius = lightCentre(index);
    return Light(index, towardsLight(centreRadius.xyz, r.p.position), centreRadius.w);
}

// Returns the light's emission, times the influence window and the shadow term. `d2`: squared length of
// light.toLight. Callers ask for it after they have computed the response, so that the emission
// occupies no registers until then.
vec3 emissionTowards(Receiver r, Light light, float d2)
{
    const vec4 emissionInfluence = lightEmission(light.index);
    vec3 emission = emissionInfluence.xyz;
    if (!IS_DISTANT)
        emission *= influenceWindow(d2, emissionInfluence.w);
    if (HAS_SHADOW_TERM)
        emission *= SHADOW_TERM(light.index, r.p.position, r.p.n, light.toLight);
    return emission;
}

// Returns a seed for sampling a light. Each pair of pixel and light has its own.
uint lightSeed(Receiver r, uint light)
{
    return pcgHash(r.sampleSeed ^ pcgHash(light));
}

// Returns the light scaled to a distance of about 1, and the scale. The response to an area light does
// not depend on the scale, and at this distance no product of lengths overflows.
Light atUnitDistance(Light light, out float scale)
{
    const float size2 = light.boundingRadius * light.boundingRadius;
    scale = inversesqrt(max(length2(light.toLight) + size2, MIN_LENGTH2));
    light.toLight *= scale;
    light.boundingRadius *= scale;
    return light;
}

#endif
