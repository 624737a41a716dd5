// SPDX-License-Identifier: Apache-2.0
// Stochastic evaluation of area lights: `count` points of a low-discrepancy sequence per light, equal
// points for equal seeds. Without bias; the truth to compare with inside the engine.
#ifndef CND_LIB_SPECULAR_SAMPLED
#define CND_LIB_SPECULAR_SAMPLED

#include "lib/brdf.glsl"
#include "lib/lights/rectangle.glsl"

// Jarzynski and Olano 2020, "Hash functions for GPU rendering": PCG.
uint pcgHash(uint x)
{
    const uint state = x * 747796405u + 2891336453u;
    const uint word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return (word >> 22u) ^ word;
}

// Roberts 2018: the additive sequence of the plastic number in 32-bit fixed point, shifted by the seed
// (Cranley and Patterson 1976). [0, 1).
vec2 lowDiscrepancy(uint i, uint seed)
{
    const uint x = i * 3242174889u + pcgHash(seed);
    const uint y = i * 2447445414u + pcgHash(seed ^ 0x9e3779b9u);
    return vec2(x >> 8u, y >> 8u) * (1.0 / 16777216.0);
}

// What a surface element of size `area` around `point` adds, with the given cosine times distance
// towards the receiver.
vec2 elementResponse(ShadingPoint p, vec3 point, float cosineTimesDistance, float area)
{
    const float d2 = max(length2(point), MIN_LENGTH2);
    const float invD = inversesqrt(d2);
    const float solidAngle = area * max(cosineTimesDistance, 0.0) * invD * invD * invD;
    return solidAngle * specularResponse(p, point * invD);
}

// Uniform in the solid angle of the cap around the unit direction c with 1 - cosine of its half angle.
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
    const vec3 areaNormal = cross(axisU, axisV); // a quarter of the area long
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

// The capsule's surface: even along its axis, caps included (Archimedes), and around it.
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
