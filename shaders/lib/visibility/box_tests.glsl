// SPDX-License-Identifier: Apache-2.0
// Tests whether the triangles in a box may hide points of a facet. They keep every box with a triangle
// that does (trianglePoints). Boxes are relative to the receiver, in the space of an instance. The
// caller has moved each side outwards by BOX_SLACK times (1 + norm1(receiver's position there)).
#ifndef CND_LIB_VISIBILITY_BOX_TESTS
#define CND_LIB_VISIBILITY_BOX_TESTS

#include "lib/visibility/light_coordinates.glsl"
#include "shared/lengths.h"

const float BOX_SLACK = 2e-6;

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

// Returns the cone of a facet from its light coordinates in the space of the boxes.
FacetCone facetCone(uint shape, FrontSurface front, LightCoordinates local)
{
    // The inverse of the matrix whose rows are u, v and z has the facet's vectors as columns.
    const bool atInfinity = front.inverseDistance == 0.0;
    const vec3 n = cross(local.u, local.v);
    const float scale = 1.0 / (dot(n, local.z) * (atInfinity ? 1.0 : front.inverseDistance));
    const vec3 c = n * scale;
    const vec3 u = abs(cross(local.v, local.z) * scale), v = abs(cross(local.z, local.u) * scale);
    const vec3 extent =
        shape == FACET_DISC
            ? vec3(length(vec2(u.x, v.x)), length(vec2(u.y, v.y)), length(vec2(u.z, v.z)))
            : u + v;
    return FacetCone(finiteInverse(c - extent), finiteInverse(c + extent),
                     atInfinity ? UNBOUNDED : 1.0);
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

// Returns a set that holds all points of the facet that triangles in the box may hide. It is meant for
// facets that are seen under 0.1 rad or more: in light coordinates of smaller ones, a float32 has too
// few digits for its bounds.
uvec2 boxPoints(uint count, uint shape, LightCoordinates g, vec3 boxMin, vec3 boxMax)
{
    const vec3 c = 0.5 * (boxMin + boxMax), h = 0.5 * (boxMax - boxMin);
    const float u = dot(g.u, c), uExtent = dot(abs(g.u), h);
    const float v = dot(g.v, c), vExtent = dot(abs(g.v), h);
    const float z = dot(g.z, c), zExtent = dot(abs(g.z), h);
    const float z0 = z - zExtent, z1 = z + zExtent;
    if (z1 <= 0.0)
        return uvec2(0u);
    // Larger than the rounding of z0.
    const bool unbounded = z0 <= 1e-6 * dot(abs(g.z), abs(c) + h);
    const float inverse0 = unbounded ? UNBOUNDED : 1.0 / z0, inverse1 = 1.0 / z1;
    const vec2 low = vec2(u - uExtent, v - vExtent), high = vec2(u + uExtent, v + vExtent);
    return pointsBetween(count, shape, 0u, low.x * (low.x > 0.0 ? inverse1 : inverse0),
                         high.x * (high.x > 0.0 ? inverse0 : inverse1)) &
           pointsBetween(count, shape, 1u, low.y * (low.y > 0.0 ? inverse1 : inverse0),
                         high.y * (high.y > 0.0 ? inverse0 : inverse1));
}

#endif
