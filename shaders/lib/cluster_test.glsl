// SPDX-License-Identifier: Apache-2.0
// Tests whether a light can light a cluster. The tests are conservative in float32: a light that adds
// to one of the cluster's samples always passes.
#ifndef CND_LIB_CLUSTER_TEST
#define CND_LIB_CLUSTER_TEST

#include "shared/cluster_data.h"
#include "lib/bounds.glsl"

// The bounds of a cluster's samples, as in Cluster, and values that every test derives from them.
struct ClusterBounds {
    Box box;
    vec3 axis;              // axis of the slab and of the cone of normals
    float slabMin, slabMax;
    float minCos, maxSin;   // cosine and sine of the half angle of the cone of normals
    vec3 ray;               // axis of the cone of samples, whose apex is the origin of view space
    float slope;            // tangent of the half angle of the cone of samples
};

ClusterBounds makeClusterBounds(Cluster c)
{
    const float sin2 = 1.0 - c.minCos * c.minCos;
    return ClusterBounds(Box(c.min, c.max), c.axis, c.slabMin, c.slabMax, c.minCos,
                         sqrt(max(sin2, 0.0)), c.ray, c.slope);
}

// Tells whether a sphere may hold a point of the cone of samples. Such a point p has
// |p x ray| <= slope p.ray and is at most `r` from the centre.
bool coneTouches(ClusterBounds c, vec3 centre, float r, float margin)
{
    const vec3 aside = cross(centre, c.ray);
    const float wide = c.slope * (dot(centre, c.ray) + margin) + (c.slope + 1.0) * r + margin;
    // No centre is farther from the ray than twice UNBOUNDED. Larger squares might overflow.
    const float limited = min(wide, 2.0 * UNBOUNDED);
    return wide >= 0.0 && dot(aside, aside) <= limited * limited;
}

// Tells whether a sample may lie in a box around spheres of influence. The box must include the margins
// for rounding that influenceBox() adds.
bool boxTouches(ClusterBounds c, Box b)
{
    const vec3 up = max(c.axis, vec3(0.0)), down = min(c.axis, vec3(0.0));
    const float lowest = dot(up, b.min) + dot(down, b.max);
    const float highest = dot(up, b.max) + dot(down, b.min);
    const vec3 centre = 0.5 * (b.min + b.max);
    const float margin = 2.0 * DOT_MARGIN * (largest(b.min) + largest(b.max));
    return all(lessThanEqual(b.min, c.box.max)) && all(greaterThanEqual(b.max, c.box.min)) &&
           lowest <= c.slabMax && highest >= c.slabMin &&
           coneTouches(c, centre, 0.5 * distance(b.min, b.max), margin);
}

// Tells whether a light may reach a sample and be above its horizon. `boundingRadius`: radius of a
// sphere that holds the emitter; `r2`: square of the light's radius of influence.
bool lightTouches(ClusterBounds c, vec3 centre, float boundingRadius, float r2)
{
    const float margin = 2.0 * DOT_MARGIN * largest(centre);
    const float r = sqrt(r2);
    const float along = dot(c.axis, centre);
    const float beyond = max(along - c.slabMax - margin, 0.0);
    // Let a be the axis and v the vector from a sample to the centre, with |v| < r and
    // a.v <= below < 0. Then n.v <= cos(cone) a.v + sin(cone) |v| for every normal n in the cone.
    const float below = along - c.slabMin + margin;
    const bool hidden = below < 0.0 && c.minCos > 0.0 &&
                        c.minCos * below + c.maxSin * r + margin <= -boundingRadius;
    return sphereTouches(c.box, centre, r2) && beyond * beyond <= r2 * BOUNDS_MARGIN && !hidden &&
           coneTouches(c, centre, r, margin);
}

// Returns what is known from the bounds about the height of a sphere above the horizons of the samples
// that its light may reach: NONE_ACROSS, ALL_ABOVE or ANY_HEIGHT. It is conservative in float32.
// `radius`: that of the sphere; `r2`: square of its radius of influence.
uint heightOfSphere(ClusterBounds c, vec3 centre, float radius, float r2)
{
    // Let a be the axis and v the vector from a sample to the centre, with a.v >= lowest > 0 and
    // |v|^2 <= farthest2. A normal n at the angle t from the axis has n.v >= cos(t) a.v - sin(t) aside,
    // where aside^2 = |v|^2 - (a.v)^2. This is lowest where t and |v| are largest and a.v is lowest.
    const float margin = 2.0 * DOT_MARGIN * largest(centre);
    const float lowest = dot(c.axis, centre) - c.slabMax - margin;
    const vec3 corner = max(abs(centre - c.box.min), abs(centre - c.box.max));
    const float farthest2 = min(r2, dot(corner, corner)) * BOUNDS_MARGIN;
    const float aside = sqrt(max(farthest2 - lowest * lowest, 0.0));
    // `rounding` exceeds the errors of this bound and of the n.v that shading computes. It is a share
    // of both terms, of 64 units of 2^-24. The length of n may be wrong by 16 such units, the n.v of
    // shading by 5, the operations here by 3, and each of two square roots by 6. The sine of a narrow
    // cone, which is computed from its cosine, is large enough because of COS_MARGIN.
    const float rounding = margin + 4.0 * DOT_MARGIN * (abs(lowest) + aside);
    const float height = c.minCos * lowest - c.maxSin * aside - rounding;
    const float above = radius * BOUNDS_MARGIN;
    if (!(lowest > 0.0 && c.minCos > 0.0 && height > above))
        return ANY_HEIGHT;
    return height >= ABOVE_FROM * above ? ALL_ABOVE : NONE_ACROSS;
}

#endif
