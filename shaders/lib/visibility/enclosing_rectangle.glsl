// SPDX-License-Identifier: Apache-2.0
// The smallest rectangle around a convex polygon. Shadows are found for points of this rectangle.
#ifndef CND_LIB_VISIBILITY_ENCLOSING_RECTANGLE
#define CND_LIB_VISIBILITY_ENCLOSING_RECTANGLE

#include "lib/visibility/facet_points.glsl"
#include "shared/lighting_data.h"

// A convex polygon in coordinates of its plane, counterclockwise. Its size is near 1. Neighbours may
// coincide.
struct FlatPolygon {
    vec2 corners[MAX_RECORD_CORNERS];
    uint count;
};

struct EnclosingRectangle {
    vec2 centre, halfU, halfV;
};

uint nextCorner(FlatPolygon polygon, uint i)
{
    return i + 1u < polygon.count ? i + 1u : 0u;
}

// Returns the rectangle with one side along a unit vector.
EnclosingRectangle rectangleAlong(FlatPolygon polygon, vec2 u)
{
    const vec2 v = vec2(-u.y, u.x);
    vec2 low = vec2(1e30), high = vec2(-1e30);
    for (uint i = 0u; i < polygon.count; ++i) {
        const vec2 at = vec2(dot(u, polygon.corners[i]), dot(v, polygon.corners[i]));
        low = min(low, at);
        high = max(high, at);
    }
    const vec2 middle = 0.5 * (low + high), extent = 0.5 * (high - low);
    return EnclosingRectangle(middle.x * u + middle.y * v, extent.x * u, extent.y * v);
}

float areaOf(EnclosingRectangle r)
{
    return dot(r.halfU, r.halfU) * dot(r.halfV, r.halfV); // its square
}

// One side of the smallest rectangle lies on an edge (Freeman and Shapira 1975).
EnclosingRectangle enclosingRectangle(FlatPolygon polygon)
{
    EnclosingRectangle best = EnclosingRectangle(vec2(0.0), vec2(1e8, 0.0), vec2(0.0, 1e8));
    for (uint i = 0u; i < polygon.count; ++i) {
        const vec2 edge = polygon.corners[nextCorner(polygon, i)] - polygon.corners[i];
        const float length2 = dot(edge, edge);
        if (length2 > 1e-20) {
            const EnclosingRectangle r = rectangleAlong(polygon, edge * inversesqrt(length2));
            if (areaOf(r) < areaOf(best))
                best = r;
        }
    }
    return best;
}

// Tells whether a point is in the polygon, or within rounding of its outline.
bool isInside(FlatPolygon polygon, vec2 point)
{
    bool inside = true;
    for (uint i = 0u; i < polygon.count; ++i) {
        const vec2 from = polygon.corners[i];
        const vec2 edge = polygon.corners[nextCorner(polygon, i)] - from, to = point - from;
        inside = inside && edge.x * to.y - edge.y * to.x >= -1e-6;
    }
    return inside;
}

// Returns which of the points of the rectangle, as a FACET_SQUARE, are in the polygon.
uvec2 pointsInside(uint count, FlatPolygon polygon, EnclosingRectangle r)
{
    uvec2 points = uvec2(0u);
    for (uint i = 0u; i < count; ++i) {
        const vec2 uv = facetPoint(count, FACET_SQUARE, i);
        const uint bit = isInside(polygon, r.centre + uv.x * r.halfU + uv.y * r.halfV) ? 1u : 0u;
        points |= i < 32u ? uvec2(bit << i, 0u) : uvec2(0u, bit << (i - 32u));
    }
    return points;
}

#endif
