// SPDX-License-Identifier: Apache-2.0
// Tests whether the triangles in a box may hide points of a facet. Boxes are relative to the receiver.
// The caller has moved each side outwards by BOX_SLACK times (1 + norm1(receiver's position)). Both
// tests keep a box, bit for bit, if they keep a box inside it. They keep a box with a triangle that
// hides points (trianglePoints), also in another space than the triangle's, if the caller has moved
// each side by roundingOf() times the distance of the farthest vertex, too.
#ifndef CND_LIB_VISIBILITY_BOX_TESTS
#define CND_LIB_VISIBILITY_BOX_TESTS

#include "lib/visibility/light_coordinates.glsl"

const float BOX_SLACK = 2e-6;
// Bound of the rounding of light coordinates, relative to the products of lengths that they sum, in any
// two spaces: boxes are tested in that of the tree over instances, too.
const float COORDINATE_SLACK = 9.5367431640625e-7; // 2^-20

// A cone with its tip at the receiver, which holds the ways to points of the facet: at the share t of
// the way, 0..1, it is the box from t low to t high.
struct FacetCone {
    vec3 inverseLow;
    vec3 inverseHigh;
    float end; // largest t: 1, or UNBOUNDED for facets at infinity
};

// Returns 1 / x without infinities.
vec3 finiteInverse(vec3 x)
{
    const vec3 size = max(abs(x), vec3(1e-30));
    return vec3(x.x < 0.0 ? -1.0 : 1.0, x.y < 0.0 ? -1.0 : 1.0, x.z < 0.0 ? -1.0 : 1.0) / size;
}

// The vectors of a facet in the space of boxes.
struct FacetVectors {
    vec3 centre;
    vec3 halfU;
    vec3 halfV;
};

// localFromView: linear part of the transform to the space of the boxes.
FacetVectors facetVectors(Facet f, mat3 localFromView)
{
    return FacetVectors(localFromView * f.centre, localFromView * f.halfU, localFromView * f.halfV);
}

// A triangle that hides one of the points is at most so far outside their bounds. It is more than a
// step of POINT_PREFIXES.
const float POINT_BOUNDS_MARGIN = 0.07;

// Bounds of points in units of the half axes: low u, low v, high u, high v.
const vec4 ALL_POINTS = vec4(-1.0, -1.0, 1.0, 1.0);

// Returns the bounds of a set of points, POINT_BOUNDS_MARGIN away from them. More than two points are
// bounded in u alone, by which points are sorted. `points` is not empty.
vec4 pointBounds(uint count, uint shape, uvec2 points)
{
    const uint first = points.x != 0u ? uint(findLSB(points.x)) : 32u + uint(findLSB(points.y));
    const uint last = points.y != 0u ? 32u + uint(findMSB(points.y)) : uint(findMSB(points.x));
    const vec2 a = facetPoint(count, shape, first), b = facetPoint(count, shape, last);
    const bool many = bitCount(points.x) + bitCount(points.y) > 2;
    const vec2 low = vec2(a.x, many ? -1.0 : min(a.y, b.y));
    const vec2 high = vec2(b.x, many ? 1.0 : max(a.y, b.y));
    return vec4(max(low - POINT_BOUNDS_MARGIN, vec2(-1.0)), min(high + POINT_BOUNDS_MARGIN, vec2(1.0)));
}

// Returns the cone of the part of a facet that lies between the bounds (pointBounds).
FacetCone facetCone(Facet f, FacetVectors v, vec4 bounds)
{
    const vec2 middle = 0.5 * (bounds.xy + bounds.zw), extent = 0.5 * (bounds.zw - bounds.xy);
    const vec3 c = v.centre + middle.x * v.halfU + middle.y * v.halfV;
    const vec3 e = extent.x * abs(v.halfU) + extent.y * abs(v.halfV);
    vec3 low = c - e, high = c + e;
    if (f.shape == FACET_DISC) {
        const vec3 disc = vec3(length(vec2(v.halfU.x, v.halfV.x)), length(vec2(v.halfU.y, v.halfV.y)),
                               length(vec2(v.halfU.z, v.halfV.z)));
        low = max(low, v.centre - disc);
        high = min(high, v.centre + disc);
    }
    const bool atInfinity = f.front.inverseDistance == 0.0;
    const float inverseUnit = atInfinity ? 1.0 : f.front.inverseDistance;
    return FacetCone(inverseUnit * finiteInverse(low), inverseUnit * finiteInverse(high),
                     atInfinity ? UNBOUNDED : 1.0);
}

// Returns how far beside a cone the rounding of light coordinates may move a point, as a share of the
// point's distance. It is much for flat lights that are seen from the edge. v, g: in one space.
float roundingOf(FacetVectors v, LightCoordinates g)
{
    const float side = length(v.halfU) + length(v.halfV);
    const float depth = length(g.z) * length(v.centre);
    return COORDINATE_SLACK * ((length(g.u) + length(g.v) + length(g.z)) * side + depth);
}

// Returns whether cone and box may touch: whether some t has t low <= boxMax and t high >= boxMin.
bool coneTouches(FacetCone cone, vec3 boxMin, vec3 boxMax)
{
    const vec3 fromLow = boxMax * cone.inverseLow, fromHigh = boxMin * cone.inverseHigh;
    float first = 0.0, last = cone.end;
    first = max(first, cone.inverseLow.x < 0.0 ? fromLow.x : 0.0);
    first = max(first, cone.inverseLow.y < 0.0 ? fromLow.y : 0.0);
    first = max(first, cone.inverseLow.z < 0.0 ? fromLow.z : 0.0);
    first = max(first, cone.inverseHigh.x > 0.0 ? fromHigh.x : 0.0);
    first = max(first, cone.inverseHigh.y > 0.0 ? fromHigh.y : 0.0);
    first = max(first, cone.inverseHigh.z > 0.0 ? fromHigh.z : 0.0);
    last = min(last, cone.inverseLow.x > 0.0 ? fromLow.x : cone.end);
    last = min(last, cone.inverseLow.y > 0.0 ? fromLow.y : cone.end);
    last = min(last, cone.inverseLow.z > 0.0 ? fromLow.z : cone.end);
    last = min(last, cone.inverseHigh.x < 0.0 ? fromHigh.x : cone.end);
    last = min(last, cone.inverseHigh.y < 0.0 ? fromHigh.y : cone.end);
    last = min(last, cone.inverseHigh.z < 0.0 ? fromHigh.z : cone.end);
    return first <= last;
}

// Returns a set that holds all points of the facet that triangles in the box may hide.
uvec2 boxPoints(uint count, uint shape, FrontSurface front, LightCoordinates g, vec3 boxMin,
                vec3 boxMax)
{
    const vec3 c = 0.5 * (boxMin + boxMax);
    vec3 h = 0.5 * (boxMax - boxMin);
    h += COORDINATE_SLACK * (norm1(c) + norm1(h));
    const vec3 middle = vec3(dot(g.u, c), dot(g.v, c), dot(g.z, c));
    const vec3 extent = vec3(dot(abs(g.u), h), dot(abs(g.v), h), dot(abs(g.z), h));
    return pointsAround(count, shape, front, middle - extent, middle + extent, 2.0 * POINT_SLACK);
}

#endif
