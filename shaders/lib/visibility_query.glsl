// SPDX-License-Identifier: Apache-2.0
// The visible points of a light, which a host that has rays finds in place of our walk through
// occluders (CANDELABRA_VISIBLE_POINTS), and what they may depend on.
#ifndef CND_LIB_VISIBILITY_QUERY
#define CND_LIB_VISIBILITY_QUERY

// lib/visibility/facet_points.glsl reads its table through this function.
uvec2 pointTable(uint i);
#include "lib/visibility/facet.glsl"

// A surface point and the points of a light that it asks for, in view space, in metres.
struct VisibilityQuery {
    uint light; // as in ShadowQuery
    uint type;  // LIGHT_*
    vec3 position;
    vec3 normal; // unit normal of the surface
    // A surface whose plane is at most so far from `position` counts as the point's own and hides
    // nothing: what the depth format and float32 cannot tell apart.
    float ownDistance;
    uint unshadowedBy; // mask of CndLight::unshadowedBy
    // The points: bit i of x, and bit i - 32 of y for the points from 32 on. Punctual lights have
    // one. There may be fewer than `count`, for example at the corners of a polygon.
    uvec2 points;
    uint count;  // 64 or 32
    Facet facet; // for lightPoint()
};

// Returns the points of q.points that the position sees; other bits are ignored. It may be called in
// code that only some lanes run.
uvec2 candelabraVisiblePoints(VisibilityQuery q);

// Returns the way from the position to a point of the light, i < q.count. It ends a little before the
// light's surface, so that geometry which is drawn there does not hide the light. For distant lights
// it is the direction, of any length.
vec3 lightPoint(VisibilityQuery q, uint i)
{
    const vec2 uv = facetPoint(q.count, q.facet.shape, i);
    const vec3 direction = q.facet.centre + uv.x * q.facet.halfU + uv.y * q.facet.halfV;
    if (q.facet.front.inverseDistance == 0.0)
        return direction;
    return direction / (q.facet.front.inverseDistance * frontFactor(q.facet.front, uv));
}

#endif
