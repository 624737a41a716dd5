// SPDX-License-Identifier: Apache-2.0
// The slope-conic specular method for sphere lights, near and distant. The integral of the lobe over
// the light is exact (conic_region.glsl, conic_clip.glsl); shadowing and Fresnel are evaluated at one
// or two nodes (conic_shading.glsl). Each of these files derives its part. A response is
// vec2(F = 1, F = (1 - VoH)^5) to a light of luminance 1, in [0, 1].
//
// Lights are in four classes (CONIC_BELOW .. CONIC_CLIPPED, shared/conic_constants.h), so that a caller
// can loop over each class separately: on llvmpipe every branch is paid for, even if no lane takes it.
// conicResponse chooses the function by itself.
#ifndef CND_LIB_SPECULAR_CONIC
#define CND_LIB_SPECULAR_CONIC

#include "lib/specular/conic_clip.glsl"

// Returns the class of a light, with heightAbove = n . toLight and d2 = |toLight|^2. It needs no
// division, because some loops only sort lights by class.
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

// Returns the response of lights with n . c >= 2 s, with one node.
vec2 conicAbove(ConicPoint p, SphereCap cap)
{
    return shadeOneNode(p, wholeCap(p, cap.c, cap.NoC, cap.s * cap.s, cap.omc));
}

// Returns the weight of the two-node response where it is mixed with the one-node response: 1 where the
// cap touches the horizon, 0 from n . c = 2 s on.
float nearness(SphereCap cap)
{
    return saturate(2.0 - cap.NoC / cap.s);
}

// Returns the response of caps that are not clipped: caps above the horizon, and small caps that cross
// it, which a substitute cap replaces. `mixed`: whether the one-node response is mixed in.
vec2 conicUnclipped(ConicPoint p, SphereCap cap, bool mixed)
{
    SubstituteCap sub = SubstituteCap(cap.c, cap.NoC, cap.s * cap.s, cap.omc);
    const SubstituteCap cut = substituteCap(p, cap);
    if (cap.NoC < cap.s)
        sub = cut;
    const float sinC = sqrt(max(1.0 - cap.NoC * cap.NoC, 0.0));
    const LightHeights z = lightHeights(p, capHeights(cap, sinC), makeCapFrame(p, sub.c, sub.NoC).v1);
    const ConicRegion o = wholeCap(p, sub.c, sub.NoC, sub.s2, sub.omc);
    const vec2 two = shadeTwoNodes(p, o, z, 0.0);
    return mixed ? mix(shadeOneNode(p, o), two, nearness(cap)) : two;
}

// Returns the response of lights with s <= n . c < 2 s, and of small lights (s^2 <= SMALL_CAP a2) with
// n . c > -s: a mixture of one and two nodes.
vec2 conicNear(ConicPoint p, SphereCap cap)
{
    return conicUnclipped(p, cap, true);
}

// Returns the response of the lights of conicAbove and conicNear, always with two nodes.
vec2 conicFullUnclipped(ConicPoint p, SphereCap cap)
{
    return conicUnclipped(p, cap, false);
}

// Returns the response of lights with |n . c| < s: the exact clip and two nodes.
vec2 conicClipped(ConicPoint p, SphereCap cap)
{
    const CapFrame f = makeCapFrame(p, cap.c, cap.NoC);
    const ConicRegion o = clippedCap(p, cap, f);
    return shadeTwoNodes(p, o, lightHeights(p, capHeights(cap, f.sinC), f.v1), 0.0);
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

// The same with two nodes for every class.
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
