// SPDX-License-Identifier: Apache-2.0
// Random and adversarial inputs for the shipping evaluation of lights. Counts responses that are NaN,
// infinite, negative or too bright and keeps the first of them, or records every configuration.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/bench.h"
#include "shared/conic_constants.h"
#include "lib/gbuffer.glsl"
#include "lib/brdf.glsl"
#include "bench/sweep_random.glsl"

layout(local_size_x = BENCH_GROUP) in;
layout(push_constant, scalar) uniform Push
{
    SweepParams params;
};
layout(scalar, binding = SWEEP_OUTPUT) writeonly buffer Output
{
    SweepRecord records[];
};
layout(scalar, binding = SWEEP_COUNTERS) buffer Counters
{
    SweepCounters counters;
};

// The current light, with the accessors through which light_eval.glsl reads lights.
vec4 centreRadius, emissionInfluence;
LightShape lightShapes[1u + CORNER_SHAPES];

vec4 lightCentre(uint light)
{
    return centreRadius;
}

vec4 lightEmission(uint light)
{
    return emissionInfluence;
}

uint lightAt(uint k)
{
    return k;
}

#include "bench/evaluate_classified.glsl"
#include "bench/sweep_cases.glsl"

#include "bench/specular_bound.glsl"

// Responses by the closed form have an upper bound. The other methods have none of use, because they
// are known to be far off.
const bool IS_CLOSED_FORM =
    specularMethod == SPECULAR_CONIC || specularMethod == SPECULAR_CONIC_FULL;

LightExtent currentExtent(ShadingPoint p)
{
    const vec3 toLight = towardsLight(centreRadius.xyz, p.position);
    const vec3 mirror = boundMirror(p, MIN_CONIC_NOV);
    if (!usesField(TYPES_WITH_AXIS_U) && !usesField(TYPES_WITH_SIDES))
        return capExtent(mirror, makeSphereCap(p.n, toLight, centreRadius.w));
    return shapeExtent(mirror, toLight, lightShapes[0],
                       usesField(TYPES_WITH_AXIS_U) && usesField(TYPES_WITH_RADIUS),
                       !usesField(TYPES_WITH_AXIS_U));
}

// Returns an upper bound of the luminance, errors included.
vec3 luminanceLimit(ShadingPoint p, LightExtent light)
{
    LightExtent wider = light;
    wider.solidAngle += SWEEP_OUTLINE_ERROR * light.squared;
    const float specular =
        specularBound(p, wider, MIN_CONIC_NOV) +
        SWEEP_CLOSED_FORM_ERROR * onAxisResponse(p, wider.solidAngle, MIN_CONIC_NOV);
    const float diffuse = min(1.01 * INV_PI * wider.solidAngle, 1.0);
    const vec3 toLight = towardsLight(centreRadius.xyz, p.position);
    const float window =
        IS_DISTANT ? 1.0 : influenceWindow(length2(toLight), emissionInfluence.w);
    return emissionInfluence.xyz * window *
        (diffuse * p.albedo + min(specular, 1.0) * max(p.F0, p.F90));
}

void count(bool condition, uint which)
{
    if (!condition)
        return;
    if (which == 0u)
        atomicAdd(counters.nan, 1u);
    else if (which == 1u)
        atomicAdd(counters.infinite, 1u);
    else if (which == 2u)
        atomicAdd(counters.negative, 1u);
    else
        atomicAdd(counters.above, 1u);
}

void main()
{
    const uint lane = gl_GlobalInvocationID.x;
    if (lane >= params.count)
        return;
    const uint index = params.firstIndex + lane;
    seedSweep(params.seed, params.slice, index);
    const SweepPoint point = makeSweepPoint(params.slice);
    makeSweepLight(params.slice, point);
    if (params.recordAll != 0u)
        emissionInfluence = vec4(1.0, 1.0, 1.0, UNBOUNDED * UNBOUNDED);

    const Surface surface =
        Surface(point.n, point.albedo, point.F0, point.F90, point.perceptualRoughness);
    ShadingPoint p = makeShadingPoint(surface, point.position, point.v);
    if (params.recordAll != 0u)
        separateLobes(p);
    const vec3 response = evaluateClassified(
        makeReceiver(p, params.sampleCount, params.sampleSeed ^ index), 0u);

    // The bits are tested, because isnan() and isinf() may be compiled to false.
    const uvec3 magnitude = floatBitsToUint(response) & 0x7FFFFFFFu;
    const bool isNan = any(greaterThan(magnitude, uvec3(0x7F800000u)));
    const bool isInfinite = any(equal(magnitude, uvec3(0x7F800000u)));
    const bool isNegative = any(lessThan(response, vec3(0.0)));
    count(isNan, 0u);
    count(isInfinite, 1u);
    count(isNegative, 2u);
    const LightExtent extent = currentExtent(p);
    const vec3 limit = luminanceLimit(p, extent);
    const bool isAbove = IS_CLOSED_FORM && !isInfinite &&
        any(greaterThan(response, limit * 1.000002 + 1e-36));
    count(isAbove, 3u);
    uint slot = lane;
    bool keep = params.recordAll != 0u;
    if (isNan || isInfinite || isNegative || isAbove) {
        const uint bad = atomicAdd(counters.bad, 1u);
        if (params.recordAll == 0u) {
            slot = bad;
            keep = bad < SWEEP_MAX_BAD;
        }
    }
    if (keep)
        records[slot] = SweepRecord(point.position, point.n, point.v, point.perceptualRoughness,
                                    centreRadius, emissionInfluence, lightShapes[0], response,
                                    specularBound(p, extent, MIN_CONIC_NOV), index);
}
