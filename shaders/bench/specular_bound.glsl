// SPDX-License-Identifier: Apache-2.0
// An upper bound of the specular response to a light, for sweep_inputs.comp. It must not be below the
// exact response. Where the exact response is far below 1, the bound should be too, so that a response
// that is far too bright is noticed.
#ifndef CND_BENCH_SPECULAR_BOUND
#define CND_BENCH_SPECULAR_BOUND

#include "lib/brdf.glsl"
#include "lib/lights/sphere_cap.glsl"

// The directions to a light, for bounds. A flat light is replaced by a rectangle that holds it.
struct LightExtent {
    float solidAngle; // at least that of the light
    float sine;       // at most the sine of half the angle between the mirror direction and the light
    float squared;    // about the solid angle of a light as wide as this one is long
};

// Returns the direction in which the eye is mirrored. Views below `minNoV` are tilted up to it.
vec3 boundMirror(ShadingPoint p, float minNoV)
{
    const float NoV = dot(p.n, p.v);
    const vec3 tangent = p.v - NoV * p.n;
    const vec3 tilted = minNoV * p.n +
        sqrt(1.0 - minNoV * minNoV) * inversesqrt(max(length2(tangent), 1e-12)) * tangent;
    return NoV < minNoV ? 2.0 * minNoV * p.n - tilted : 2.0 * NoV * p.n - p.v;
}

// Returns the sine of the difference of two angles up to 90 degrees, given by their sines; 0 if it is
// negative.
float sineOfDifference(float x, float y)
{
    return max(x * sqrt(max(1.0 - y * y, 0.0)) - y * sqrt(max(1.0 - x * x, 0.0)), 0.0);
}

LightExtent capExtent(vec3 mirror, SphereCap cap)
{
    const float centre = min(0.5 * length(cap.c - mirror), 1.0);
    const float angle = 2.0 * PI * cap.omc;
    return LightExtent(angle, sineOfDifference(centre, sqrt(0.5 * cap.omc)), angle);
}

// Returns the sine of half the smallest angle between a direction and the points of a segment. The
// nearest point is that at which the cosine is stationary, or an end; as all three are points of the
// segment, rounding of the place changes the angle in second order only.
float halfSineToSegment(vec3 direction, vec3 from, vec3 to)
{
    const vec3 along = to - from;
    const float a = dot(direction, from);
    const float b = dot(direction, along);
    const float c = length2(from);
    const float d = dot(from, along);
    const float e = length2(along);
    const float divisor = b * d - a * e;
    const float t = clamp((a * d - b * c) / (abs(divisor) > 0.0 ? divisor : 1.0), 0.0, 1.0);
    const vec3 nearest = from + t * along;
    const float nearest2 = min(length2(normalize(nearest) - direction),
                               min(length2(normalize(from) - direction),
                                   length2(normalize(to) - direction)));
    return min(0.5 * sqrt(nearest2), 1.0);
}

// Returns a lower bound of the distance from the origin to centre + x u + y v, |x|, |y| <= 1, for
// perpendicular axes and lengths of about 1. It is 0 for receivers on the light, as far as rounding
// tells.
float leastDistance(vec3 centre, vec3 u, vec3 v)
{
    const float x = clamp(-dot(centre, u) / max(length2(u), 1e-36), -1.0, 1.0);
    const float y = clamp(-dot(centre, v) / max(length2(v), 1e-36), -1.0, 1.0);
    return max(0.999 * length(centre + x * u + y * v) - 1e-5, 0.0);
}

vec3 unitAxis(vec3 a)
{
    const float largest = max(max(abs(a.x), abs(a.y)), abs(a.z));
    return normalize(a / max(largest, 1e-36)); // the square of a small axis would underflow
}

// An element of the surface at the distance r, whose normal makes an angle with the direction to it,
// has a solid angle of (its area) cos(angle) / r^2, and r cos(angle) is the distance of the light's
// plane.
LightExtent flatExtent(vec3 mirror, vec3 centre, vec3 u, vec3 v)
{
    const vec3 across = cross(unitAxis(u), unitAxis(v));
    const float height = dot(across, centre);
    const float least = leastDistance(centre, u, v);
    const float area = 4.0 * length(u) * length(v);
    const float least3 = max(least * least * least, 1e-20);
    const float longer = max(length(u), length(v));
    LightExtent o;
    o.solidAngle =
        least > 0.0 ? min(1.01 * (abs(height) + 1e-6) * area / least3, 2.0 * PI) : 2.0 * PI;
    o.squared = min(PI * longer * longer / max(least * least, 1e-20), 2.0 * PI);
    // The mirror ray's hit of the plane, in the light's own coordinates.
    const float approach = dot(across, mirror);
    const vec3 hit = mirror * (height / (abs(approach) > 0.0 ? approach : 1e-20)) - centre;
    const bool isInside = height * approach >= 0.0 &&
        abs(dot(hit, u)) <= length2(u) && abs(dot(hit, v)) <= length2(v);
    const float sine = min(min(halfSineToSegment(mirror, centre - u - v, centre + u - v),
                               halfSineToSegment(mirror, centre + u - v, centre + u + v)),
                           min(halfSineToSegment(mirror, centre + u + v, centre - u + v),
                               halfSineToSegment(mirror, centre - u + v, centre - u - v)));
    o.sine = isInside || least < 1e-4 ? 0.0 : max(0.999 * sine - 1e-6, 0.0);
    return o;
}

// A tube consists of spheres around the points of its segment. In pieces of the segment the angle S of
// the nearest sphere serves for all of them. So the light lies within S of an arc of the length of
// that piece as seen, which takes up at most 2 (length) sin S + 2 pi (1 - cos S).
LightExtent tubeExtent(vec3 mirror, vec3 centre, vec3 u, float radius)
{
    const uint pieces = 8u;
    LightExtent o = LightExtent(0.0, 1.0, 0.0);
    for (uint k = 0u; k < pieces; ++k) {
        const vec3 from = centre + (2.0 * float(k) / float(pieces) - 1.0) * u;
        const vec3 to = centre + (2.0 * float(k + 1u) / float(pieces) - 1.0) * u;
        const float least = leastDistance(0.5 * (from + to), 0.5 * (to - from), vec3(0.0));
        const float s = radius < least ? radius / least : 1.0;
        const float omc = 1.0 - sqrt(max(1.0 - s * s, 0.0));
        const float tinyOmc = s < 0.01 ? 0.501 * s * s : omc; // 1 - cos would round to 0
        const float angle = min(length(to - from) / max(least, 1e-10), PI);
        o.solidAngle += 2.0 * angle * s + 2.0 * PI * tinyOmc;
        const float sine = least < 1e-4 ? 0.0 : halfSineToSegment(mirror, from, to);
        o.sine = min(o.sine, sineOfDifference(sine, sqrt(0.5 * tinyOmc)));
    }
    const float least = max(leastDistance(centre, u, vec3(0.0)), 1e-10);
    const float longer = min((length(u) + radius) / least, 1.0);
    o.solidAngle = min(o.solidAngle, 2.0 * PI);
    o.sine = max(0.999 * o.sine - 1e-6, 0.0);
    o.squared = 2.0 * PI * longer * longer;
    return o;
}

// Returns the extent of a light with a shape and a position; toLight and the shape may have any length.
LightExtent shapeExtent(vec3 mirror, vec3 toLight, LightShape shape, bool isTube, bool isDisc)
{
    vec3 u = shape.axisU, v = shape.axisV;
    if (isDisc) { // in a square
        u = shape.radius * anyPerpendicular(shape.axisU);
        v = cross(shape.axisU, u);
    }
    const vec3 size = abs(toLight) + abs(u) + (isTube ? vec3(shape.radius) : abs(v));
    const float scale = 1.0 / max(max(max(size.x, size.y), size.z), 1e-36);
    if (isTube)
        return tubeExtent(mirror, scale * toLight, scale * u, scale * shape.radius);
    return flatExtent(mirror, scale * toLight, scale * u, scale * v);
}

// Returns an upper bound of the exact response with F = 1. The response is the integral of
// D G2 / (4 NoL NoV) NoL over the light, which is at most 1.
//
// With x the half vector's angle from n, D is at most alpha^2 / (pi w^2) with
// w = alpha^2 + (1 - alpha^2) sin^2 x for the smallest x. The mirror direction is turned into the
// direction of a half vector's light by half turns about n and about the half vector, which make up a
// rotation by 2 x. So 2 x is at least the angle between the mirror direction and the light.
// G2 / (4 NoL NoV) NoL is at most 1 / (2 smithV) (see specularResponse).
float specularBound(ShadingPoint p, LightExtent light, float minNoV)
{
    const float NoV = max(dot(p.n, p.v), minNoV);
    const float a2 = p.alpha * p.alpha;
    const float smithV = sqrt(a2 + (1.0 - a2) * NoV * NoV);
    const float w = a2 + (1.0 - a2) * light.sine * light.sine;
    // The solid angle comes last: its product with a2 may be denormal, which GPUs flush to zero.
    return min((0.5 * INV_PI) * a2 / (w * w * smithV) * light.solidAngle, 1.0);
}

// Returns the approximate response to a light of this solid angle in the mirror direction. It is exact
// for a sphere on the normal and the view along the normal: tan^2 (S / 2) / (alpha^2 + tan^2 (S / 2)).
float onAxisResponse(ShadingPoint p, float solidAngle, float minNoV)
{
    const float NoV = max(dot(p.n, p.v), minNoV);
    const float a2 = p.alpha * p.alpha;
    const float x = solidAngle * (0.25 * INV_PI) / (a2 * sqrt(a2 + (1.0 - a2) * NoV * NoV));
    return x / (1.0 + x);
}

#endif
