// SPDX-License-Identifier: Apache-2.0
#ifndef CND_LIB_MATH
#define CND_LIB_MATH

const float PI = 3.14159265358979;
const float HALF_PI = 1.57079632679490;
const float INV_PI = 0.318309886183791;

// Squared lengths are not inverted below this value, so that inversesqrt is finite if points coincide.
const float MIN_LENGTH2 = 1e-30;

// Smallest NoV. Interpolated and mapped normals can face away from the viewer: they are shaded as if
// the view were grazing.
const float MIN_NOV = 1e-4;

float saturate(float x)
{
    return clamp(x, 0.0, 1.0);
}

float pow5(float x)
{
    const float x2 = x * x;
    return x2 * x2 * x;
}

float length2(vec3 x)
{
    return dot(x, x);
}

// Returns the dot product with the same bits in every pipeline. dot() may be rounded differently where
// a compiler fuses its sums in one pipeline and not in another; precise fma() may not.
float invariantDot(vec3 a, vec3 b)
{
    precise const float sum = fma(a.z, b.z, fma(a.y, b.y, a.x * b.x));
    return sum;
}

// Returns some unit vector perpendicular to z, which is a unit vector.
vec3 anyPerpendicular(vec3 z)
{
    return normalize(cross(z, abs(z.x) < 0.5 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0)));
}

#endif
