// SPDX-License-Identifier: Apache-2.0
#ifndef CND_LIB_BOUNDS
#define CND_LIB_BOUNDS

#include "shared/lengths.h"

struct Box {
    vec3 min, max;
};

// Tests of bounds multiply the squared radius of a light by this. Shading compares the squared distance
// of a point to the light with the same squared radius. Rounded differences of coordinates keep their
// order, so what remains are the roundings of the two squared distances (three each: a product and two
// sums) and of the product with this margin: seven, each of at most 2^-24 of the value.
const float BOUNDS_MARGIN = 1.0 + 8.0 / 16777216.0;

// Times the largest coordinate of a vector, this exceeds the rounding error of its dot product with a
// unit vector.
const float DOT_MARGIN = 1.0 / 1048576.0;

// Returns the largest magnitude of a coordinate.
float largest(vec3 x)
{
    return max(abs(x.x), max(abs(x.y), abs(x.z)));
}

// A box around a light is enlarged by this share of the light's centre and influence radius, so that
// neither rounding here nor in the tests of the box loses the light.
const float BOX_MARGIN = 1.0 / 1048576.0;

// Returns a box around the sphere of influence of a light, whose squared radius is `r2`.
Box influenceBox(vec3 centre, float r2)
{
    const float r = sqrt(r2);
    const float widened = r + BOX_MARGIN * (r + largest(centre));
    return Box(max(centre - widened, -UNBOUNDED), min(centre + widened, UNBOUNDED));
}

// Tells whether a box holds a point. A node of the light tree whose box does not hold a point has no
// light that reaches it.
bool boxHolds(Box b, vec3 p)
{
    return all(lessThanEqual(b.min, p)) && all(lessThanEqual(p, b.max));
}

// Tells whether a sphere of squared radius `r2` may hold a point of the box. It is conservative in
// float32 for points whose coordinates were used, bit for bit, to make the box; boxes of clusters are
// widened by how far other kernels may place the same points (lib/cluster_margins.glsl).
bool sphereTouches(Box b, vec3 centre, float r2)
{
    const vec3 outside = max(max(b.min - centre, centre - b.max), vec3(0.0));
    return dot(outside, outside) <= r2 * BOUNDS_MARGIN;
}

#endif
