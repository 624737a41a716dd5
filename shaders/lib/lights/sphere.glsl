// SPDX-License-Identifier: Apache-2.0
// Diffuse of a sphere light: its exact form factor, horizon included.
#ifndef CND_LIB_LIGHTS_SPHERE
#define CND_LIB_LIGHTS_SPHERE

#include "lib/math.glsl"

// (asin(z) - z) / z^3 as a polynomial in z2 = z^2 in [0, 0.5]; minimax, error 9.7e-8.
float asinTail(float z2)
{
    float k = 0.0878251772;
    k = k * z2 - 0.0528741847;
    k = k * z2 + 0.0508166768;
    k = k * z2 + 0.0247934903;
    k = k * z2 + 0.0451521326;
    k = k * z2 + 0.0749828032;
    return k * z2 + 0.166666761;
}

// Form factor F = E / (pi L) of a spherical cap that crosses the horizon, for c >= 0; the exact
// expression (1/pi) [c s^2 theta + asin(m / sin b) - m cos s] with every term positive.
float crossingFormFactor(float c2, float s2)
{
    const float c = sqrt(c2);
    const float ib = inversesqrt(max(1.0 - c2, 1e-12));
    const float cs = sqrt(max(1.0 - s2, 0.0));
    const float m = sqrt(max(s2 - c2, 0.0));
    const float v = m * ib; // sine and ...
    const float q = cs * ib; // ... cosine of one angle
    const float is = inversesqrt(max(s2, 1e-36));
    const float ny = c * q * is; // -cos(theta)
    const float w = v * is;      // sin(theta)
    const float z1 = min(ny, w);
    const float t1 = z1 + z1 * z1 * z1 * asinTail(z1 * z1);
    const float asinNy = ny < w ? t1 : HALF_PI - t1;
    const float z2 = min(v, q);
    const float t2 = z2 * z2 * z2 * asinTail(z2 * z2); // asin(z2) - z2
    const float kk = (c2 + s2 - c2 * s2) * ib / (1.0 + (1.0 - c2) * ib * cs); // (v - m cs) / m
    const float e = v < q ? t2 + m * kk : HALF_PI - (z2 + t2) - m * cs; // asin(v) - m cs
    return INV_PI * (c * s2 * (HALF_PI + asinNy) + e);
}

// Form factor F = E / (pi L) of a sphere seen under c = cos(angle of its centre to the normal) and
// s2 = (R / d)^2, in [0, 1] for any c in [-1, 1]. s2 is clamped to 1: inside the sphere the value of
// its surface continues, F = (1 + c) / 2. Absolute error below 2e-7 s^3.
// Closed form: Snyder 1996 (area light sources), Lagarde and de Rousiers 2014, section 4.7.2; the
// float32 form uses F(c) - F(-c) = c s^2 so that no terms cancel.
float sphereFormFactor(float c, float s2)
{
    s2 = min(s2, 1.0);
    const float c2 = c * c;
    if (c2 >= s2)
        return max(c, 0.0) * s2; // wholly above or wholly below the horizon
    const float f = crossingFormFactor(c2, s2);
    return max(c < 0.0 ? f + c * s2 : f, 0.0);
}

#endif
