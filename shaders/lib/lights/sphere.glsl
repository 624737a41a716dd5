// SPDX-License-Identifier: Apache-2.0
// Diffuse lighting by a sphere light: its exact form factor, also where the sphere crosses the horizon.
#ifndef CND_LIB_LIGHTS_SPHERE
#define CND_LIB_LIGHTS_SPHERE

#include "lib/math.glsl"

// Returns (atan(t) - t) / t^3, a minimax polynomial in t2 = t^2 for t in [0, 1], whose error is 9.9e-8.
float sphereAtanTail(float t2)
{
    float k = 0.00386673891;
    k = k * t2 - 0.0200267476;
    k = k * t2 + 0.0489143215;
    k = k * t2 - 0.0800968172;
    k = k * t2 + 0.108657591;
    k = k * t2 - 0.142570449;
    k = k * t2 + 0.199986812;
    return k * t2 - 0.333333231;
}

// Returns the form factor F = E / (pi L) of a spherical cap that crosses the horizon. With s the sine
// of its half angle, q = sqrt(1 - s^2) the cosine and m = sqrt(s^2 - c^2),
//   F = (1 / pi) [c s^2 (pi / 2 + atan(c q / m)) + atan(m / q) - m q].
// Both arc tangents are taken of the shorter side over the longer one, so q and m are the only square
// roots. The last two terms cancel for small lights. They are computed as t s^2 + (atan(t) - t) with
// t = m / q.
float crossingFormFactor(float c, float s2)
{
    const float cs = sqrt(1.0 - s2);
    const float m = sqrt(abs(s2 - c * c)); // abs: a fused multiply-add may round below 0
    const float y = abs(c) * cs;
    const bool steep = m < y;
    const float t1 = (steep ? m : y) / ((steep ? y : m) + 1e-30);
    const float a1 = t1 + t1 * t1 * t1 * sphereAtanTail(t1 * t1);
    const float elevation = steep ? HALF_PI - a1 : a1;
    const float theta = HALF_PI + (c < 0.0 ? -elevation : elevation);
    const bool narrow = m < cs;
    const float t2 = narrow ? m / cs : cs / m;
    const float tail = t2 * t2 * t2 * sphereAtanTail(t2 * t2);
    const float e = narrow ? t2 * s2 + tail : HALF_PI - (t2 + tail) - m * cs;
    return INV_PI * abs(c * s2 * theta + e);
}

// Returns the form factor F = E / (pi L) of a sphere of radius R at the distance d. c in [-1, 1] is the
// cosine of the angle between the normal and the direction to the centre; s2 = (R / d)^2 in [0, 1].
// Callers inside the sphere clamp s2 to 1 and get what its surface gets, F = (1 + c) / 2. The absolute
// error is below 2e-7 s^3. The closed form is from Snyder 1996 (area light sources) and Lagarde and
// de Rousiers 2014, section 4.7.2.
float sphereFormFactor(float c, float s2)
{
    // No branch: on llvmpipe it cost more than the terms that it skips (DECISIONS 24).
    const float crossing = crossingFormFactor(c, s2);
    const bool whole = c * c >= s2; // the sphere is wholly above or wholly below the horizon
    return whole ? max(c, 0.0) * s2 : crossing;
}

#endif
