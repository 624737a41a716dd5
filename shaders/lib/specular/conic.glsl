// SPDX-License-Identifier: Apache-2.0
// The slope-conic specular method for sphere lights, near and distant. The integral of the lobe over
// the light is exact (conic_region.glsl, conic_clip.glsl); shadowing and Fresnel are evaluated at one
// or two nodes (conic_shading.glsl). Each of these files derives its part. A response is
// vec2(F = 1, F = (1 - VoH)^5) to a light of luminance 1, in [0, 1].
//
// Lights are in classes by their height above the horizon, each with a function of its own
// (shading/classify_lights.glsl), because on llvmpipe every branch is paid for, even if no lane takes
// it.
#ifndef CND_LIB_SPECULAR_CONIC
#define CND_LIB_SPECULAR_CONIC

#include "lib/specular/conic_clip.glsl"

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

// Returns the response of caps that are not clipped: caps above the horizon, and small caps (s^2 <=
// SMALL_CAP alpha^2) that cross it, which a substitute cap replaces. `mixed`: whether the one-node
// response is mixed in, for caps with n . c < 2 s.
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

// Returns the response of lights with |n . c| < s: the exact clip and two nodes.
vec2 conicClipped(ConicPoint p, SphereCap cap)
{
    const CapFrame f = makeCapFrame(p, cap.c, cap.NoC);
    const ConicRegion o = clippedCap(p, cap, f);
    return shadeTwoNodes(p, o, lightHeights(p, capHeights(cap, f.sinC), f.v1), 0.0);
}

#endif
