// SPDX-License-Identifier: Apache-2.0
// Slope-conic specular of sphere lights, near and distant: the lobe over the light is exact
// (conic_region.glsl, conic_clip.glsl), shadowing and Fresnel are taken at one or two nodes
// (conic_shading.glsl). Each of these files derives its part. Responses are
// vec2(F = 1, F = (1 - VoH)^5) to a light of luminance 1, in [0, 1].
//
// Lights come in four classes (CONIC_BELOW .. CONIC_CLIPPED, shared/conic_constants.h), so that a
// caller can loop over each apart: on llvmpipe a masked branch is always paid. conicResponse picks the
// function by itself.
#ifndef CND_LIB_SPECULAR_CONIC
#define CND_LIB_SPECULAR_CONIC

#include "lib/specular/conic_clip.glsl"

// heightAbove = n . toLight; d2 = |toLight|^2. There is no division, for loops that only sort lights.
uint conicClass(float heightAbove, float radius, float d2, float a2)
{
    const float r2 = min(radius * radius, MAX_SPECULAR_S2 * d2);
    const float signed2 = heightAbove * abs(heightAbove);
    if (signed2 <= -r2)
        return CONIC_BELOW;
    if (signed2 >= 4.0 * r2)
        return CONIC_ABOVE;
    return signed2 >= r2 || r2 <= SMALL_CAP * a2 * d2 ? CONIC_NEAR : CONIC_CLIPPED;
}

// For n . c >= 2 s: one node.
vec2 conicAbove(ConicPoint p, SphereCap cap)
{
    return shadeOneNode(p, wholeCap(p, cap.c, cap.NoC, cap.s * cap.s, cap.omc));
}

// Share of the response with two nodes in that with both: 1 where the cap touches the horizon, 0 from
// n . c = 2 s on.
float nearness(SphereCap cap)
{
    return saturate(2.0 - cap.NoC / cap.s);
}

// The region and its two-node shading where the clip is not evaluated: caps above the horizon, and
// small ones that cross it.
vec2 conicUnclipped(ConicPoint p, SphereCap cap, bool mixed)
{
    SubstituteCap sub = SubstituteCap(cap.c, cap.NoC, cap.s * cap.s, cap.omc);
    const SubstituteCap cut = substituteCap(p, cap);
    if (cap.NoC < cap.s)
        sub = cut;
    const float sinC = sqrt(max(1.0 - cap.NoC * cap.NoC, 0.0));
    const LightHeights z = lightHeights(p, cap, sinC, makeCapFrame(p, sub.c, sub.NoC).v1);
    const ConicRegion o = wholeCap(p, sub.c, sub.NoC, sub.s2, sub.omc);
    const vec2 two = shadeTwoNodes(p, o, z);
    return mixed ? mix(shadeOneNode(p, o), two, nearness(cap)) : two;
}

// For s <= n . c < 2 s, and any n . c > -s with s^2 <= SMALL_CAP a2: one and two nodes, mixed.
vec2 conicNear(ConicPoint p, SphereCap cap)
{
    return conicUnclipped(p, cap, true);
}

// Two nodes wherever conicAbove and conicNear are meant.
vec2 conicFullUnclipped(ConicPoint p, SphereCap cap)
{
    return conicUnclipped(p, cap, false);
}

// For |n . c| < s: the exact clip, two nodes.
vec2 conicClipped(ConicPoint p, SphereCap cap)
{
    const CapFrame f = makeCapFrame(p, cap.c, cap.NoC);
    const LightHeights z = lightHeights(p, cap, f.sinC, f.v1);
    return shadeTwoNodes(p, clippedCap(p, cap, f), z);
}

uint conicClassOf(ConicPoint p, SphereCap cap)
{
    return conicClass(cap.NoC, cap.s, 1.0, p.a2);
}

vec2 conicResponse(ConicPoint p, SphereCap cap)
{
    switch (conicClassOf(p, cap)) {
    case CONIC_ABOVE:
        return conicAbove(p, cap);
    case CONIC_NEAR:
        return conicNear(p, cap);
    case CONIC_CLIPPED:
        return conicClipped(p, cap);
    }
    return vec2(0.0);
}

// Two nodes for every light, whatever its class.
vec2 conicFullResponse(ConicPoint p, SphereCap cap)
{
    switch (conicClassOf(p, cap)) {
    case CONIC_ABOVE:
    case CONIC_NEAR:
        return conicFullUnclipped(p, cap);
    case CONIC_CLIPPED:
        return conicClipped(p, cap);
    }
    return vec2(0.0);
}

#endif
