// SPDX-License-Identifier: Apache-2.0
// Tests whether the triangles in a box may hide points of a facet. Boxes are relative to the receiver.
// The caller has moved each side outwards by BOX_SLACK times (1 + norm1(receiver's position)). Both
// tests keep a box, bit for bit, if they keep a box inside it. Of boxes in another space than the
// triangle's, they keep those with a triangle that hides points (trianglePoints) if the caller has also
// moved each side by roundingOf() times the distance of the farthest vertex.
#ifndef CND_LIB_VISIBILITY_BOX_TESTS
#define CND_LIB_VISIBILITY_BOX_TESTS

#include "lib/visibility/light_coordinates.glsl"

const float BOX_SLACK = 2e-6;
// Bound of the rounding of light coordinates, relative to the products of lengths that they sum, in any
// two spaces: boxes are tested in that of the tree over instances, too.
const float COORDINATE_SLACK = 9.5367431640625e-7; // 2^-20

// A cone with its tip at the receiver, which holds all points in front of the facet: at the share t of
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

// localFromView: linear part of the transform to the space of the boxes.
FacetCone facetCone(Facet f, mat3 localFromView)
{
    const vec3 c = localFromView * f.centre, u = localFromView * f.halfU;
    const vec3 v = localFromView * f.halfV;
    const vec3 extent =
        f.shape == FACET_DISC
            ? vec3(length(vec2(u.x, v.x)), length(vec2(u.y, v.y)), length(vec2(u.z, v.z)))
            : abs(u) + abs(v);
    const bool atInfinity = f.front.inverseDistance == 0.0;
    const float inverseUnit = atInfinity ? 1.0 : f.front.inverseDistance;
    return FacetCone(inverseUnit * finiteInverse(c - extent), inverseUnit * finiteInverse(c + extent),
                     atInfinity ? UNBOUNDED : 1.0);
}

// Returns how far beside a cone the rounding of light coordinates may move a point, as a share of the
// point's distance. It is much for flat lights that are seen from the edge.
float roundingOf(Facet f, LightCoordinates g)
{
    const float side = length(f.halfU) + length(f.halfV);
    const float depth = length(g.z) * length(f.centre);
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
