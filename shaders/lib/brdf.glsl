// SPDX-License-Identifier: Apache-2.0
// Lambert and isotropic GGX with height-correlated Smith shadowing and Schlick Fresnel.
#ifndef CND_LIB_BRDF
#define CND_LIB_BRDF

#include "lib/math.glsl"
#include "lib/surface.glsl"
#include "shared/lighting_data.h"

// Everything about a shaded point that does not depend on the light. Directions are unit vectors and
// point away from the surface.
struct ShadingPoint {
    vec3 position; // view space, m
    vec3 n;
    vec3 v;
    vec3 mirror;   // v reflected about n
    float NoV;     // clamped to >= MIN_NOV
    float alpha;   // GGX width, >= MIN_ALPHA
    float smithV;  // sqrt(alpha^2 + (1 - alpha^2) NoV^2)
    vec3 albedo;   // diffuse albedo
    vec3 F0;
    vec3 F90;      // 0: no specular lobe; a value per channel, because joinLobes may scale it
};

// Sets NoV, mirror and smithV, which follow from n, v and alpha.
void deriveTerms(inout ShadingPoint p)
{
    p.NoV = max(dot(p.n, p.v), MIN_NOV);
    p.mirror = 2.0 * p.NoV * p.n - p.v;
    const float a2 = p.alpha * p.alpha;
    p.smithV = sqrt(a2 + (1.0 - a2) * p.NoV * p.NoV);
}

ShadingPoint makeShadingPoint(Surface surface, vec3 position, vec3 towardsEye)
{
    ShadingPoint p;
    p.position = position;
    p.n = surface.normal;
    p.v = normalize(towardsEye);
    p.alpha = max(surface.perceptualRoughness * surface.perceptualRoughness, MIN_ALPHA);
    deriveTerms(p);
    p.albedo = surface.albedo;
    p.F0 = surface.F0;
    p.F90 = vec3(surface.specularWeight);
    return p;
}

// Returns the specular lobe times the cosine, F D G2 / (4 NoL NoV) NoL per steradian, with F = 1 (x)
// and with F = (1 - VoH)^5 (y).
// D is from Trowbridge and Reitz 1975, written with |n x h|^2 of the half vector before it is
// normalised, because NoH^2 (a2 - 1) + 1 cancels near the peak. G2 / (4 NoL NoV) is eq. 99 of Heitz
// 2014.
vec2 specularResponse(ShadingPoint p, vec3 l)
{
    const float NoL = dot(p.n, l);
    const vec3 h = p.v + l;
    const float h2 = max(dot(h, h), MIN_LENGTH2);
    const float a2 = p.alpha * p.alpha;
    const vec3 nxh = cross(p.n, h);
    const float noh = dot(p.n, h);
    // width = h2 (NoH^2 (a2 - 1) + 1) >= h2 a2. The max matters only for l = -v, where h vanishes.
    const float width = max(dot(nxh, nxh) + noh * noh * a2, h2 * a2);
    const float smithL = sqrt(a2 + (1.0 - a2) * NoL * NoL);
    const float visibility = 0.5 / (NoL * p.smithV + p.NoV * smithL);
    const float q = h2 / width;
    const float d = a2 * INV_PI * q * q;
    const float VoH = saturate(dot(p.v, h) * inversesqrt(h2));
    const float a = NoL > 0.0 ? d * visibility * NoL : 0.0;
    return vec2(a, a * pow5(1.0 - VoH));
}

// Returns Fresnel's term of Schlick 1994 integrated over a light, F0 (A - B) + F90 B, where A and B
// are the responses to the light with F = 1 and with F = (1 - VoH)^5.
vec3 schlick(ShadingPoint p, vec2 response)
{
    return p.F0 * (response.x - response.y) + p.F90 * response.y;
}

// The responses of a surface's lobes to a light.
struct LightResponse {
    // The response of the diffuse lobe with albedo 1. This is the form factor E / (pi L), 0..1, or for
    // punctual lights E / pi per unit of intensity or illuminance.
    float formFactor;
    vec2 specular;    // with F = 1 and with F = (1 - VoH)^5; 0 without a lobe
};

// Returns the luminance of a surface per emission of the light that has these responses.
vec3 reflected(ShadingPoint p, LightResponse response)
{
    return p.albedo * response.formFactor + schlick(p, response.specular);
}

#endif
