// SPDX-License-Identifier: Apache-2.0
// Outgoing luminance of one shaded point under one light. The includer provides lightCentre(),
// lightEmission(), lightAux[] and ltcTexel(); with CANDELABRA_VISIBILITY lightIds[], and the host the
// shadow term.
#ifndef CND_SHADING_LIGHT_EVAL
#define CND_SHADING_LIGHT_EVAL

#include "shading/light_families.glsl"
#include "shading/light_reach.glsl"
#include "lib/lights/sphere.glsl"
#include "shading/lobes_of_class.glsl"
#ifdef CANDELABRA_VISIBILITY
#include "lib/shadow_query.glsl"
#endif
#if HAS_CONIC
#include "lib/specular/conic.glsl"
#endif
#include "lib/specular/karis.glsl"
#include "lib/specular/kx.glsl"
#include "lib/specular/sampled.glsl"
#if HAS_COSINES
#include "lib/lights/disc.glsl"
#include "lib/lights/rectangle.glsl"
#include "lib/lights/tube.glsl"
#include "lib/specular/ltc.glsl"
#include "lib/specular/representative.glsl"
#endif

// areaMethod: of tubes, rectangles and discs.
#if LIGHT_FAMILY == FAMILY_ALL
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

// Of the lobe's highest response, the largest error of one shading node where a light is between one
// and two of its half angles above the horizon, for F0 = 0.04 and F0 = 1: measured, 3,000 surfaces.
const vec2 ONE_NODE_ERROR = vec2(0.21, 0.063);

// What a pixel prepares once for all lights.
struct Receiver {
    ShadingPoint p;
#if HAS_COSINES
    LtcPoint ltc; // IS_LTC
#endif
    uint sampleCount; // SPECULAR_SAMPLED
    uint sampleSeed;
    float aboveFrom; // spheres: n . toLight / R from which one is evaluated as above the horizon
#if HAS_CONIC
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
#if HAS_COSINES
    if (IS_LTC)
        r.ltc = makeLtcPoint(p);
#endif
#if HAS_CONIC
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

// (1 - (d / r)^4)^2 for d < r, else 0; 1 for infinite r. Lagarde and de Rousiers 2014, eq. 26.
float influenceWindow(float d2, float influenceRadius2)
{
    const float x = min(d2 / influenceRadius2, 1.0);
    const float w = 1.0 - x * x;
    return w * w;
}

// What is known of a light at a point.
struct Light {
    uint index;
    vec3 toLight;
    float reach;
    vec3 emission; // times the influence window
};

Light readLight(Receiver r, uint index)
{
    const vec4 centreReach = lightCentre(index);
    const vec4 emissionInfluence = lightEmission(index);
    Light light;
    light.index = index;
    light.toLight = towardsLight(centreReach.xyz, r.p.position);
    light.reach = centreReach.w;
    light.emission = emissionInfluence.xyz;
    if (!IS_DISTANT)
        light.emission *= influenceWindow(length2(light.toLight), emissionInfluence.w);
#ifdef CANDELABRA_VISIBILITY
    light.emission *= candelabraVisibility(
        ShadowQuery(lightIds[index], lightType, r.p.position, r.p.n, light.toLight));
#endif
    return light;
}

// Each light has samples of its own.
uint lightSeed(Receiver r, uint light)
{
    return pcgHash(r.sampleSeed ^ pcgHash(light));
}

// The diffuse lobe's response to light that gives a white surface so much.
vec3 diffuseResponse(ShadingPoint p, float formFactor)
{
    return HAS_DIFFUSE ? p.albedo * formFactor : vec3(0.0);
}

#include "shading/eval_sphere.glsl"
#include "shading/eval_area.glsl"
#include "shading/eval_punctual.glsl"

// Outgoing luminance by evaluation. A function each: drivers inline all of it at every call before
// they drop what specialisation rules out, and one function for all took minutes to compile.
#define EVALUATION(name, response)                                                                 \
    vec3 name(Receiver r, uint index)                                                              \
    {                                                                                              \
        const Light light = readLight(r, index);                                                   \
        return light.emission * response(r, light);                                                \
    }

#if HAS_CONIC
EVALUATION(evaluateAsPoint, sphereAsPoint)
EVALUATION(evaluateNear, sphereNear)
#endif
#if HAS_SPHERES
EVALUATION(evaluateAbove, sphereAbove)
#endif
#if LIGHT_FAMILY == FAMILY_ALL
EVALUATION(evaluateAcross, sphereAcross)
EVALUATION(evaluateTube, tubeResponse)
EVALUATION(evaluateRectangle, rectangleResponse)
EVALUATION(evaluateDisc, discResponse)
EVALUATION(evaluatePunctual, punctualResponse)
#elif HAS_SPHERES
EVALUATION(evaluateGeneral, sphereAcross)
#elif HAS_TUBES
EVALUATION(evaluateGeneral, tubeResponse)
#elif HAS_RECTANGLES
EVALUATION(evaluateGeneral, rectangleResponse)
#elif HAS_DISCS
EVALUATION(evaluateGeneral, discResponse)
#else
EVALUATION(evaluateGeneral, punctualResponse)
#endif

#endif
