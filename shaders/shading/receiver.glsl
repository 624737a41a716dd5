// SPDX-License-Identifier: Apache-2.0
// The specular method, and what a surface point prepares once for all lights.
#ifndef CND_SHADING_RECEIVER
#define CND_SHADING_RECEIVER

#include "lib/brdf.glsl"
#include "shading/light_families.glsl"
#include "shared/lighting.h"
#ifdef LIGHT_FAMILY_CONIC
#include "lib/specular/conic.glsl"
#endif
#ifdef HAS_COSINES
#include "lib/specular/ltc.glsl"
#endif

// areaMethod: of tubes, rectangles and discs.
#ifdef LIGHT_FAMILY_ALL
const uint specularMethod = SPECULAR_CONIC;
const uint areaMethod = SPECULAR_LTC;
const bool HAS_BUDGET = false;
#else
layout(constant_id = SPEC_SPECULAR_METHOD) const uint specularMethod = SPECULAR_CONIC;
layout(constant_id = SPEC_ERROR_BUDGET) const uint errorBudget = 0u;
const uint areaMethod = specularMethod;
const bool HAS_BUDGET = errorBudget != 0u;
#endif
const bool IS_LTC = areaMethod == SPECULAR_LTC;

// The bound of the error of a point is not proven for errors of the specular lobe beyond this.
const float MAX_POINT_ERROR = 0.3;

// Largest error, relative to the lobe's highest response, of one shading node for a light between one
// and two of its half angles above the horizon, for F0 = 0.04 and F0 = 1: measured, 3,000 surfaces.
const vec2 ONE_NODE_ERROR = vec2(0.21, 0.063);

// What a pixel prepares once for all lights.
struct Receiver {
    ShadingPoint p;
#ifdef HAS_COSINES
    LtcPoint ltc; // IS_LTC
#endif
    uint sampleCount; // SPECULAR_SAMPLED
    uint sampleSeed;
    float aboveFrom; // spheres: n . toLight / R from which one is evaluated as above the horizon
#ifdef LIGHT_FAMILY_CONIC
    ConicPoint conic;
    float smallCap;   // (R / d)^2 up to which a sphere across the horizon is not clipped
    float pointLimit; // (R / d)^2 up to which one above the horizon is evaluated as a point
#endif
};

// An error budget as a share of the specular lobe's highest response. The diffuse part is exact, so
// the budget grows by what that adds to the response: a specular peak of at most
// F s^2 / (4 alpha^2 NoV) against albedo s^2.
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

// Largest (R / d)^2 whose evaluation as a point, at least two of its half angles above the horizon,
// errs by at most `share` of the lobe's highest response. With q = (s^2 / 8 alpha^2) (1 + 1 / NoV^2)
// the error was below 1.1 q for F0 = 1 and below (1.15 + 3.9 alpha) q for F0 = 0.04, whose Fresnel
// term changes over the light: measured, q < 0.3, 1,400 surfaces with 80 lights each.
float pointLimit(ShadingPoint p, float share)
{
    const float perQ = 1.15 + 3.9 * p.alpha * (1.0 - lowestF0(p));
    const float q = min(share, MAX_POINT_ERROR) / perQ;
    return q * 8.0 * p.alpha * p.alpha / (1.0 + 1.0 / (p.NoV * p.NoV));
}

// `sampleSeed`: of the pixel.
Receiver makeReceiver(ShadingPoint p, float budget, uint sampleCount, uint sampleSeed)
{
    Receiver r;
    r.p = p;
    r.sampleCount = sampleCount;
    r.sampleSeed = sampleSeed;
#ifdef HAS_COSINES
    if (IS_LTC)
        r.ltc = makeLtcPoint(p);
#endif
#ifdef LIGHT_FAMILY_CONIC
    r.conic = makeConicPoint(p);
    const float share = HAS_BUDGET ? specularShare(p, budget) : 0.0;
    const float oneNodeError = mix(ONE_NODE_ERROR.x, ONE_NODE_ERROR.y, lowestF0(p));
    const bool oneNode = specularMethod == SPECULAR_CONIC && share >= oneNodeError;
    r.aboveFrom = oneNode ? 1.0 : 2.0;
    r.smallCap = SMALL_CAP * r.conic.a2;
    r.pointLimit = pointLimit(p, share);
#else
    r.aboveFrom = 1.0;
#endif
    return r;
}

#endif
