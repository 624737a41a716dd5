// SPDX-License-Identifier: Apache-2.0
#ifndef CND_LIB_MATH
#define CND_LIB_MATH

const float PI = 3.14159265358979;
const float HALF_PI = 1.57079632679490;
const float INV_PI = 0.318309886183791;

// Smallest squared length that is inverted: keeps rsqrt finite for coincident points.
const float MIN_LENGTH2 = 1e-30;

float saturate(float x)
{
    return clamp(x, 0.0, 1.0);
}

float pow5(float x)
{
    const float x2 = x * x;
    return x2 * x2 * x;
}

// log2 of 1 <= m <= 2 as 2 / ln 2 atanh((m - 1) / (m + 1)), to 2e-8 relative. log2() itself is off by
// 2^-21 where Vulkan is kept to and by 1e-4 on lavapipe (Mesa 22.3), which one could measure.
float log2Mantissa(float m)
{
    const float s = (m - 1.0) / (m + 1.0);
    const float s2 = s * s;
    float sum = 1.0 / 13.0;
    sum = sum * s2 + 1.0 / 11.0;
    sum = sum * s2 + 1.0 / 9.0;
    sum = sum * s2 + 1.0 / 7.0;
    sum = sum * s2 + 1.0 / 5.0;
    sum = sum * s2 + 1.0 / 3.0;
    sum = sum * s2 + 1.0;
    return 2.88539008 * s * sum;
}

float length2(vec3 x)
{
    return dot(x, x);
}

#endif
