// SPDX-License-Identifier: Apache-2.0
#ifndef CND_LIB_BOUNDS
#define CND_LIB_BOUNDS

struct Box {
    vec3 min, max;
};

// The test below adds this much to the squared radius: three products, two sums and one square each
// round by at most half an ulp on either side, together below 8 ulp = 8 * 2^-24.
const float BOUNDS_MARGIN = 1.0 + 8.0 / 16777216.0;

// Share of the coordinates' size that exceeds the rounding error of a dot product with a unit vector.
const float DOT_MARGIN = 1.0 / 1048576.0;

float largest(vec3 x)
{
    return max(abs(x.x), max(abs(x.y), abs(x.z)));
}

// Whether a sphere of squared radius `r2` may reach a point of the box. Conservative in float32 for
// points whose coordinates were used, bit for bit, to make the box.
bool sphereTouches(Box b, vec3 centre, float r2)
{
    const vec3 outside = max(max(b.min - centre, centre - b.max), vec3(0.0));
    return dot(outside, outside) <= r2 * BOUNDS_MARGIN;
}

#endif
