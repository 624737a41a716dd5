// SPDX-License-Identifier: Apache-2.0
// An upper bound of the specular response to a light, for sweep_inputs.comp.
#ifndef CND_BENCH_SPECULAR_BOUND
#define CND_BENCH_SPECULAR_BOUND

#include "lib/brdf.glsl"
#include "lib/lights/sphere_cap.glsl"

// Returns an upper bound of the exact response with F = 1 to a light within `cap`. The response is the
// integral of D G2 / (4 NoL NoV) NoL over the cap, which is at most 1.
//
// With x the half vector's angle from n, D is at most alpha^2 / (pi w^2) with
// w = alpha^2 + (1 - alpha^2) sin^2 x for the smallest x. The mirror direction is turned into the
// direction of a half vector's light by half turns about n and about the half vector, which make up a
// rotation by 2 x. So 2 x is at least the angle between the mirror direction and the cap.
// G2 / (4 NoL NoV) NoL is at most 1 / (2 smithV) (see specularResponse), and the solid angle of the cap
// is 2 pi (1 - cos S).
//
// Views below `minNoV` are tilted up to it.
float specularBound(ShadingPoint p, SphereCap cap, float minNoV)
{
    const float NoV = dot(p.n, p.v);
    const vec3 tangent = p.v - NoV * p.n;
    const vec3 tilted = minNoV * p.n +
        sqrt(1.0 - minNoV * minNoV) * inversesqrt(max(length2(tangent), 1e-12)) * tangent;
    const vec3 v = NoV < minNoV ? tilted : p.v;
    const float seenNoV = max(NoV, minNoV);
    const vec3 mirror = 2.0 * seenNoV * p.n - v;
    const float a2 = p.alpha * p.alpha;
    const float smithV = sqrt(a2 + (1.0 - a2) * seenNoV * seenNoV);
    // Sines of half the angles between the mirror direction and the cap's centre and rim.
    const float centre = min(0.5 * length(cap.c - mirror), 1.0);
    const float rim = sqrt(0.5 * cap.omc);
    const float sine = max(centre * sqrt(1.0 - rim * rim) - rim * sqrt(1.0 - centre * centre), 0.0);
    const float w = a2 + (1.0 - a2) * sine * sine;
    return min(cap.omc * a2 / (w * w * smithV), 1.0);
}

// Returns the approximate response to a light of half angle asin(s) on the mirror axis, as its namesake
// in tools/candelabra/measure/stability does.
float onAxisResponse(float s, float alpha, float NoV)
{
    const float l1 = 0.5 * s / alpha;
    const float l2 = l1 / NoV;
    return l1 * l2 * inversesqrt((1.0 + l1 * l1) * (1.0 + l2 * l2));
}

#endif
