// SPDX-License-Identifier: Apache-2.0
// Which points of a facet a triangle hides from the receiver. The result is a union over triangles, so
// it depends on no order.
#ifndef CND_LIB_VISIBILITY_TRIANGLE_POINTS
#define CND_LIB_VISIBILITY_TRIANGLE_POINTS

#include "lib/visibility/light_coordinates.glsl"
#include "lib/visibility/own_surface.glsl"

// Bound of the rounding of an edge condition, relative to the L1 norms of the edge's ends. Both
// triangles of an edge count a point this near to it, so that closed surfaces leak no point.
const float EDGE_SLACK = 2.384185791015625e-7; // 2^-22
// Each condition of a triangle is k.x u + k.y v + k.z >= 0, evaluated in this order. Rounding keeps the
// order of sums, so a rejection of all points never contradicts the evaluation of one of them.
bool rejectsAllPoints(vec3 k)
{
    precise const float largest = (abs(k.x) + abs(k.y)) + k.z;
    return largest < 0.0;
}

float atPoint(vec3 k, vec2 uv)
{
    precise const float value = (k.x * uv.x + k.y * uv.y) + k.z;
    return value;
}

// cross(), which negates every bit of its result if a and b are exchanged.
vec3 preciseCross(vec3 a, vec3 b)
{
    precise const vec3 c = vec3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
    return c;
}

// Returns the condition that a point is on the inner side of the edge, or within its slack.
vec3 edgeCondition(vec3 a, vec3 b, float side)
{
    const vec3 edge = side * preciseCross(a, b);
    return vec3(edge.x, edge.y, edge.z + EDGE_SLACK * norm1(a) * norm1(b));
}

// Returns whether the plane of a triangle is so near to the receiver that the triangle may be the
// receiver's own. n: normal of the plane in light coordinates; height = dot(n, vertex).
bool isOwnSurface(LightCoordinates local, mat3 localFromView, vec3 n, vec3 vertex, float height,
                  float ownDistance)
{
    // The length is that in view space, where ownDistance is measured.
    const vec3 normal = (n.x * local.u + n.y * local.v + n.z * local.z) * localFromView;
    const float size = max(max(abs(normal.x), max(abs(normal.y), abs(normal.z))), 1e-30);
    const float rounding = dot(abs(n), abs(vertex)) * PLANE_SLACK;
    return abs(height) <= ownDistance * length(normal / size) * size + rounding;
}

// The four conditions under which a triangle hides a point. edge*: >= 0. front: at least
// behind (1 + FRONT_SLACK + kappa g), which is left out for facets at infinity.
struct TriangleConditions {
    vec3 edge0;
    vec3 edge1;
    vec3 edge2;
    vec3 front;
    float behind;
};

bool hidesPoint(TriangleConditions k, FrontSurface front, vec2 uv)
{
    const float nearest = k.behind * frontFactor(front, uv);
    return min(min(atPoint(k.edge0, uv), atPoint(k.edge1, uv)), atPoint(k.edge2, uv)) >= 0.0 &&
           (front.inverseDistance == 0.0 || atPoint(k.front, uv) >= nearest);
}

// points: half of a mask, `first` the index of its first point.
uint hiddenInWord(TriangleConditions k, FrontSurface front, uint count, uint shape, uint points,
                  uint first)
{
    uint hidden = 0u;
    for (uint left = points; left != 0u; left &= left - 1u) {
        const uint i = uint(findLSB(left));
        // A lane that is done may run this once more (shading/software_drivers.glsl).
        if (left != 0u && hidesPoint(k, front, facetPoint(count, shape, first + i)))
            hidden |= 1u << i;
    }
    return hidden;
}

// Returns which of the points `lit` of a facet a triangle hides.
// local: light coordinates in the triangle's space (inSpaceOf); localFromView: linear part of the
// transform to it. va, vb, vc: the vertices minus the receiver's position, in this space.
// ownDistance: ownSurfaceDistance().
// turns: grows by the turns that loops take.
// In light coordinates the triangle's products of three lengths must stay below 1e38: vertices may be
// 1e8 m away.
uvec2 trianglePoints(uint count, uint shape, FrontSurface front, LightCoordinates local,
                     mat3 localFromView, vec3 va, vec3 vb, vec3 vc, float ownDistance, uvec2 lit,
                     inout uint turns)
{
    const vec3 a = toLightCoordinates(local, va), b = toLightCoordinates(local, vb);
    const vec3 c = toLightCoordinates(local, vc);
    const vec3 n = preciseCross(b - a, c - a);
    const float height = dot(n, a);
    const float side = height < 0.0 ? -1.0 : 1.0;
    const TriangleConditions k = TriangleConditions(
        edgeCondition(a, b, side), edgeCondition(b, c, side), edgeCondition(c, a, side), side * n,
        abs(height) * front.inverseDistance);
    if (rejectsAllPoints(k.edge0) || rejectsAllPoints(k.edge1) || rejectsAllPoints(k.edge2))
        return uvec2(0u);
    const float behind = k.behind * (1.0 + FRONT_SLACK);
    if (front.inverseDistance > 0.0 && rejectsAllPoints(vec3(k.front.x, k.front.y, k.front.z - behind)))
        return uvec2(0u);
    if (isOwnSurface(local, localFromView, n, a, height, ownDistance))
        return uvec2(0u);
    const uvec2 tested = lit & pointsAround(count, shape, front, min(a, min(b, c)),
                                             max(a, max(b, c)), POINT_SLACK);
    turns += uint(bitCount(tested.x) + bitCount(tested.y));
    uvec2 hidden = uvec2(hiddenInWord(k, front, count, shape, tested.x, 0u), 0u);
    if (count > 32u)
        hidden.y = hiddenInWord(k, front, count, shape, tested.y, 32u);
    return hidden;
}

#endif
