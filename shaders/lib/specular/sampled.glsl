// SPDX-License-Identifier: Apache-2.0
// Evaluation of area lights by sampling: `count` points of a low-discrepancy sequence per light, the
// same points for the same seed. It has no bias, so the other methods can be compared with it inside
// the engine.
#ifndef CND_LIB_SPECULAR_SAMPLED
#define CND_LIB_SPECULAR_SAMPLED

#include "lib/brdf.glsl"
#include "lib/lights/rectangle_facing.glsl"

// The hash function PCG (Jarzynski and Olano 2020, "Hash functions for GPU rendering").
uint pcgHash(uint x)
{
    const uint state = x * 747796405u + 2891336453u;
    const uint word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return (word >> 22u) ^ word;
}

// Returns point i in [0, 1)^2 of the additive sequence of the plastic number (Roberts 2018), in 32-bit
// fixed point and shifted by the seed (Cranley and Patterson 1976).
vec2 lowDiscrepancy(uint i, uint seed)
{
    const uint x = i * 3242174889u + pcgHash(seed);
    const uint y = i * 2447445414u + pcgHash(seed ^ 0x9e3779b9u);
    return vec2(x >> 8u, y >> 8u) * (1.0 / 16777216.0);
}

// Returns the response to an element of the emitter with the given area around `point`.
// `cosineTimesDistance`: cosine between its normal and the direction to the receiver, times the
// distance.
vec2 elementResponse(ShadingPoint p, vec3 point, float cosineTimesDistance, float area)
{
    const float d2 = max(length2(point), MIN_LENGTH2);
    const float invD = inversesqrt(d2);
    const float solidAngle = area * max(cosineTimesDistance, 0.0) * invD * invD * invD;
    return solidAngle * specularResponse(p, point * invD);
}

// The samples are uniform in the solid angle of the cap around the unit direction c.
// `oneMinusCosine`: 1 - cosine of the cap's half angle.
vec2 sampledSphere(ShadingPoint p, vec3 c, float oneMinusCosine, uint count, uint seed)
{
    const vec3 u = anyPerpendicular(c);
    const vec3 v = cross(c, u);
    vec2 sum = vec2(0.0);
    for (uint i = 0u; i < count; ++i) {
        const vec2 x = lowDiscrepancy(i, seed);
        const float omc = oneMinusCosine * x.x;
        const float sine = sqrt(max(omc * (2.0 - omc), 0.0));
        const float angle = 2.0 * PI * x.y;
        const vec3 l = (1.0 - omc) * c + sine * (cos(angle) * u + sin(angle) * v);
        sum += specularResponse(p, l);
    }
    return sum * (2.0 * PI * oneMinusCosine / float(max(count, 1u)));
}

vec2 sampledRectangle(ShadingPoint p, vec3 toCentre, vec3 axisU, vec3 axisV, bool twoSided, uint count,
                      uint seed)
{
    if (!facesRectangle(toCentre, axisU, axisV, twoSided))
        return vec2(0.0);
    const vec3 areaNormal = cross(axisU, axisV); // its length is a quarter of the area
    const float facing = abs(dot(areaNormal, toCentre));
    vec2 sum = vec2(0.0);
    for (uint i = 0u; i < count; ++i) {
        const vec2 x = 2.0 * lowDiscrepancy(i, seed) - 1.0;
        sum += elementResponse(p, toCentre + x.x * axisU + x.y * axisV, facing, 4.0);
    }
    return sum / float(max(count, 1u));
}

vec2 sampledDisc(ShadingPoint p, vec3 toCentre, vec3 normal, float radius, bool twoSided, uint count,
                 uint seed)
{
    const float h = dot(normal, toCentre);
    if (!twoSided && h >= 0.0)
        return vec2(0.0);
    const vec3 u = anyPerpendicular(normal);
    const vec3 v = cross(normal, u);
    const float area = PI * radius * radius;
    vec2 sum = vec2(0.0);
    for (uint i = 0u; i < count; ++i) {
        const vec2 x = lowDiscrepancy(i, seed);
        const float angle = 2.0 * PI * x.y;
        const float r = radius * sqrt(x.x);
        sum += elementResponse(p, toCentre + r * (cos(angle) * u + sin(angle) * v), abs(h), area);
    }
    return sum / float(max(count, 1u));
}

// The samples are uniform on the capsule's surface: uniform around the axis and, by Archimedes' theorem
// also on the end caps, uniform along the axis.
vec2 sampledTube(ShadingPoint p, vec3 toCentre, vec3 axis, float radius, uint count, uint seed)
{
    const float axisLength = sqrt(max(length2(axis), MIN_LENGTH2));
    const vec3 along = length2(axis) > MIN_LENGTH2 ? axis / axisLength : vec3(0.0, 0.0, 1.0);
    const vec3 u = anyPerpendicular(along);
    const vec3 v = cross(along, u);
    const float halfLength = axisLength + radius;
    const float area = 4.0 * PI * radius * halfLength;
    vec2 sum = vec2(0.0);
    for (uint i = 0u; i < count; ++i) {
        const vec2 x = lowDiscrepancy(i, seed);
        const float height = halfLength * (2.0 * x.x - 1.0);
        const float onAxis = clamp(height, -axisLength, axisLength);
        const float cap = (height - onAxis) / max(radius, 1e-18);
        const float angle = 2.0 * PI * x.y;
        const vec3 around = cos(angle) * u + sin(angle) * v;
        const vec3 normal = cap * along + sqrt(max(1.0 - cap * cap, 0.0)) * around;
        const vec3 point = toCentre + onAxis * along + radius * normal;
        sum += elementResponse(p, point, -dot(normal, point), area);
    }
    return sum / float(max(count, 1u));
}

#endif
