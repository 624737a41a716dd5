// SPDX-License-Identifier: Apache-2.0
// Coordinates in which the receiver is the origin and a facet is the square |u|, |v| <= z.
#ifndef CND_LIB_VISIBILITY_LIGHT_COORDINATES
#define CND_LIB_VISIBILITY_LIGHT_COORDINATES

#include "lib/visibility/facet.glsl"

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

#endif
