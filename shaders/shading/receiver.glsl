// SPDX-License-Identifier: Apache-2.0
// The specular method, and the values that a surface point prepares once for all lights.
#ifndef CND_SHADING_RECEIVER
#define CND_SHADING_RECEIVER

#include "lib/brdf.glsl"
#include "shading/light_families.glsl"
#include "shared/lighting.h"
#ifdef LIGHT_FAMILY_CONIC
#include "lib/specular/conic.glsl"
#endif
#ifdef HAS_OUTLINES
#include "lib/outline/outline.glsl"
#endif

// specularMethod is the method for spheres, areaMethod the one for tubes, rectangles, discs and
// polygons.
#ifdef LIGHT_FAMILY_ALL
const uint specularMethod = SPECULAR_CONIC;
const uint areaMethod = SPECULAR_CONIC;
const bool HAS_BUDGET = false;
#else
layout(constant_id = SPEC_SPECULAR_METHOD) const uint specularMethod = SPECULAR_CONIC;
layout(constant_id = SPEC_ERROR_BUDGET) const uint errorBudget = 0u;
const uint areaMethod = specularMethod;
const bool HAS_BUDGET = errorBudget != 0u;
#endif
const bool BY_OUTLINE = areaMethod == SPECULAR_CONIC || areaMethod == SPECULAR_CONIC_FULL;

// The error bound for lights evaluated as points was measured only for errors of the specular lobe up
// to this.
const float MAX_POINT_ERROR = 0.3;

// Largest error, relative to the lobe's highest response, of one shading node for a light between one
// and two of its half angles above the horizon, for F0 = 0.04 and F0 = 1 (measured on 3,000 surfaces).
const vec2 ONE_NODE_ERROR = vec2(0.21, 0.063);

// The values that a pixel prepares once for all lights.
struct Receiver {
    ShadingPoint p;
    uint sampleCount; // SPECULAR_SAMPLED: samples per light
    uint sampleSeed;
    float aboveFrom; // spheres with n . toLight / R >= aboveFrom are evaluated as above the horizon
#if defined(LIGHT_FAMILY_CONIC) || defined(HAS_OUTLINES)
    ConicPoint conic;
    float pointLimit; // lights above the horizon with (R / d)^2 < pointLimit are evaluated as points
#endif
#ifdef HAS_OUTLINES
    OutlineFrame frame;
#endif
};

// Returns an error budget, which is relative to the highest response of both lobes, as a share of the
// specular lobe's highest response. The diffuse response is exact, so the budget grows by its share:
// albedo s^2, against a specular peak of at most F s^2 / (4 alpha^2 NoV).
float specularShare(ShadingPoint p, float budget)
{
    const vec3 F = mix(p.F0, vec3(p.F90), pow5(1.0 - p.NoV));
    const float F1 = max(max(F.x, F.y), max(F.z, 1e-6));
    const float albedo = min(p.albedo.x, min(p.albedo.y, p.albedo.z));
    return budget * (1.0 + 4.0 * p.alpha * p.alpha * p.NoV * albedo / F1);
}

float lowestF0(ShadingPoint p)
{
    return min(p.F0.x, min(p.F0.y, p.F0.z));
}

// Returns the largest (R / d)^2 of a light at least two of its half angles above the horizon for which
// the evaluation as a point has an error of at most `share` of the lobe's highest response. With
// q = (s^2 / 8 alpha^2) (1 + 1 / NoV^2), the error was below 1.1 q for F0 = 1 and below
// (1.15 + 3.9 alpha) q for F0 = 0.04, where Fresnel's term changes over the light (measured for q < 0.3
// on 1,400 surfaces with 80 lights each).
float pointLimit(ShadingPoint p, float share)
{
    const float perQ = 1.15 + 3.9 * p.alpha * (1.0 - lowestF0(p));
    const float q = min(share, MAX_POINT_ERROR) / perQ;
    return q * 8.0 * p.alpha * p.alpha / (1.0 + 1.0 / (p.NoV * p.NoV));
}

// `budget`: largest error, relative to the highest response; `sampleSeed`: the seed of the pixel.
Receiver makeReceiver(ShadingPoint p, float budget, uint sampleCount, uint sampleSeed)
{
    Receiver r;
    r.p = p;
    r.sampleCount = sampleCount;
    r.sampleSeed = sampleSeed;
#if defined(LIGHT_FAMILY_CONIC) || defined(HAS_OUTLINES)
    r.conic = makeConicPoint(p);
    const float share = HAS_BUDGET ? specularShare(p, budget) : 0.0;
    const float oneNodeError = mix(ONE_NODE_ERROR.x, ONE_NODE_ERROR.y, lowestF0(p));
    const bool oneNode =
        HAS_BUDGET && specularMethod == SPECULAR_CONIC && share >= oneNodeError;
    r.aboveFrom = oneNode ? 1.0 : ABOVE_FROM;
    r.pointLimit = pointLimit(p, share);
#else
    r.aboveFrom = 1.0;
#endif
#ifdef HAS_OUTLINES
    r.frame = makeOutlineFrame(r.conic);
#endif
    return r;
}

#endif
