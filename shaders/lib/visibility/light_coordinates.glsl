// SPDX-License-Identifier: Apache-2.0
// Coordinates in which the receiver is the origin and a facet is the square |u|, |v| <= z.
#ifndef CND_LIB_VISIBILITY_LIGHT_COORDINATES
#define CND_LIB_VISIBILITY_LIGHT_COORDINATES

#include "lib/visibility/facet.glsl"
#include "shared/lengths.h"

// A point x relative to the receiver has the light coordinates (u, v, z) = (dot(u, x), dot(v, x),
// dot(z, x)). They are in metres for facets at infinity and else in a unit near it; the facet lies at
// z = 1 / inverseDistance. Seen from the receiver, the point covers the point (u / z, v / z) of the
// facet.
struct LightCoordinates {
    vec3 u;
    vec3 v;
    vec3 z;
};

// The facet has members.
LightCoordinates lightCoordinates(Facet f)
{
    const vec3 n = cross(f.halfU, f.halfV);
    const float scale = 1.0 / dot(n, f.centre);
    return LightCoordinates(cross(f.halfV, f.centre) * scale, cross(f.centre, f.halfU) * scale,
                            n * scale);
}

// Returns the same coordinates for points in the space of an instance. viewFromLocal: linear part.
LightCoordinates inSpaceOf(LightCoordinates view, mat3 viewFromLocal)
{
    return LightCoordinates(view.u * viewFromLocal, view.v * viewFromLocal, view.z * viewFromLocal);
}

vec3 toLightCoordinates(LightCoordinates g, vec3 x)
{
    precise const vec3 uvz =
        vec3(g.u.x * x.x + g.u.y * x.y + g.u.z * x.z, g.v.x * x.x + g.v.y * x.y + g.v.z * x.z,
             g.z.x * x.x + g.z.y * x.y + g.z.z * x.z);
    return uvz;
}

float norm1(vec3 x)
{
    return abs(x.x) + abs(x.y) + abs(x.z);
}

// Returns a set that holds all points that are covered by a body whose light coordinates lie between
// the bounds, and points at most a step of POINT_PREFIXES beside it. A body inside it has no more.
uvec2 pointsAround(uint count, uint shape, FrontSurface front, vec3 low, vec3 high, float slack)
{
    if (high.z <= 0.0 || low.z * front.inverseDistance > 1.0 + slack)
        return uvec2(0u);
    const float nearest = low.z > 0.0 ? 1.0 / low.z : UNBOUNDED, farthest = 1.0 / high.z;
    return pointsBetween(count, shape, 0u, low.x * (low.x > 0.0 ? farthest : nearest),
                         high.x * (high.x > 0.0 ? nearest : farthest), slack) &
           pointsBetween(count, shape, 1u, low.y * (low.y > 0.0 ? farthest : nearest),
                         high.y * (high.y > 0.0 ? nearest : farthest), slack);
}

#endif
