// SPDX-License-Identifier: Apache-2.0
// Representative points of area lights, after Karis 2013, "Real Shading in Unreal Engine 4". All light
// comes from the emitter's point nearest to the mirror ray. For each direction in which the emitter
// extends, the lobe is scaled down as if the extent had widened it:
//   alpha / min(alpha + extent / (2 d), 1).
// This is cheap. The accuracy benchmark shows its errors.
#ifndef CND_LIB_SPECULAR_REPRESENTATIVE
#define CND_LIB_SPECULAR_REPRESENTATIVE

#include "lib/brdf.glsl"
#include "lib/lights/rectangle_facing.glsl"

float narrowing(ShadingPoint p, float extent, float invDistance)
{
    return p.alpha / min(p.alpha + 0.5 * extent * invDistance, 1.0);
}

// Returns the response to a light of the given solid angle in the direction of `point`, scaled by
// `factor`. It is at most 1, because no lobe reflects more light than it receives.
vec2 representativeResponse(ShadingPoint p, vec3 point, float solidAngle, float factor)
{
    const vec3 l = point * inversesqrt(max(length2(point), MIN_LENGTH2));
    const vec2 response = solidAngle * factor * specularResponse(p, l);
    return response * min(1.0 / max(response.x, 1e-30), 1.0);
}

// Returns approximately the solid angle of a planar light; it is exact in the limit of a small light.
float planarSolidAngle(vec3 toCentre, vec3 normal, float area, float extent2)
{
    const float invD = inversesqrt(max(length2(toCentre) + extent2, MIN_LENGTH2));
    return min(area * abs(dot(normal, toCentre)) * invD * invD * invD, 2.0 * PI);
}

// Returns the point where the mirror ray meets the plane of a light, relative to the light's centre. A
// ray that does not approach the plane is bent until it meets the plane far away, on the side to which
// it points.
vec3 mirrorHit(ShadingPoint p, vec3 toCentre, vec3 normal)
{
    const float facing = dot(normal, toCentre) < 0.0 ? -1.0 : 1.0;
    const float approach = max(facing * dot(normal, p.mirror), 1e-3);
    const vec3 hit = p.mirror * (facing * dot(normal, toCentre) / approach) - toCentre;
    return hit - dot(hit, normal) * normal;
}

vec2 representativeRectangle(ShadingPoint p, vec3 toCentre, vec3 axisU, vec3 axisV, bool twoSided)
{
    if (!facesRectangle(toCentre, axisU, axisV, twoSided))
        return vec2(0.0);
    const float u2 = max(length2(axisU), MIN_LENGTH2);
    const float v2 = max(length2(axisV), MIN_LENGTH2);
    const float u = sqrt(u2);
    const float v = sqrt(v2);
    const vec3 normal = cross(axisU, axisV) / (u * v);
    const vec3 hit = mirrorHit(p, toCentre, normal);
    const vec3 point = toCentre + clamp(dot(hit, axisU) / u2, -1.0, 1.0) * axisU +
                       clamp(dot(hit, axisV) / v2, -1.0, 1.0) * axisV;
    const float invD = inversesqrt(max(length2(toCentre), MIN_LENGTH2));
    return representativeResponse(p, point, planarSolidAngle(toCentre, normal, 4.0 * u * v, u2 + v2),
                                  narrowing(p, u, invD) * narrowing(p, v, invD));
}

vec2 representativeDisc(ShadingPoint p, vec3 toCentre, vec3 normal, float radius, bool twoSided)
{
    if (!twoSided && dot(normal, toCentre) >= 0.0)
        return vec2(0.0);
    const vec3 hit = mirrorHit(p, toCentre, normal);
    const vec3 point = toCentre + hit * min(radius * inversesqrt(max(length2(hit), MIN_LENGTH2)), 1.0);
    const float invD = inversesqrt(max(length2(toCentre), MIN_LENGTH2));
    const float factor = narrowing(p, radius, invD);
    const float area = PI * radius * radius;
    return representativeResponse(p, point, planarSolidAngle(toCentre, normal, area, radius * radius),
                                  factor * factor);
}

// Takes the segment's point nearest to the mirror ray, then the nearest point of the sphere around it.
vec2 representativeTube(ShadingPoint p, vec3 toCentre, vec3 axis, float radius)
{
    const float axis2 = max(length2(axis), MIN_LENGTH2);
    const float centreAlong = dot(p.mirror, toCentre);
    const float axisAlong = dot(p.mirror, axis);
    const float t = (centreAlong * axisAlong - dot(toCentre, axis)) /
                    max(axis2 - axisAlong * axisAlong, 1e-6 * axis2);
    const vec3 onAxis = toCentre + clamp(t, -1.0, 1.0) * axis;
    const vec3 toRay = dot(onAxis, p.mirror) * p.mirror - onAxis;
    const float reach = radius * inversesqrt(max(length2(toRay), MIN_LENGTH2));
    const vec3 point = onAxis + toRay * min(reach, 1.0);
    const float axisLength = sqrt(axis2);
    const float invD = inversesqrt(max(length2(onAxis), MIN_LENGTH2));
    // The solid angle is that of a thin strip along the axis and of two half discs at its ends.
    const float along = dot(toCentre, axis) / axisLength;
    const float across2 =
        max(length2(toCentre) - along * along, max(radius * radius, MIN_LENGTH2));
    const float far = along + axisLength;
    const float near = along - axisLength;
    const float invFar = inversesqrt(across2 + far * far);
    const float invNear = inversesqrt(across2 + near * near);
    // The strip is 2 R / H (sin(elevation of far) - sin(elevation of near)), where H is the distance of
    // the axis' line, written without cancellation.
    const float inv = invFar * invNear;
    const float cosBetween = (across2 + far * near) * inv;
    const float strip = 4.0 * radius * axisLength * sqrt(across2) * (invFar + invNear) * inv /
                        max(1.0 + cosBetween, 1e-6);
    const float solidAngle = min(strip + PI * radius * radius * inv, 2.0 * PI);
    return representativeResponse(p, point, solidAngle,
                                  narrowing(p, radius, invD) * narrowing(p, axisLength + radius, invD));
}

#endif
