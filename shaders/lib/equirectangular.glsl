// SPDX-License-Identifier: Apache-2.0
// Integrals over rectangles of an equirectangular image. A rectangle spans an interval of the polar
// angle theta, from +y, and one of the azimuth phi, from -z towards +x. Sines of small angles are
// small here to all digits, which those of a device need not be.
#ifndef CND_LIB_EQUIRECTANGULAR
#define CND_LIB_EQUIRECTANGULAR

#include "lib/math.glsl"

// Returns the sine of x, |x| <= pi / 4.
float smallSine(float x)
{
    const float x2 = x * x;
    return x - x * x2 * (1.0 / 6.0 - x2 * (1.0 / 120.0 - x2 * (1.0 / 5040.0)));
}

// Returns the cosine and the sine of x, 0 <= x <= pi / 2.
vec2 cosSinOfQuadrant(float x)
{
    // The angle is halved for the series, then doubled.
    const float s = smallSine(0.5 * x);
    const float x2 = 0.25 * x * x;
    const float c =
        1.0 - x2 * (0.5 - x2 * (1.0 / 24.0 - x2 * (1.0 / 720.0 - x2 * (1.0 / 40320.0))));
    return vec2(1.0 - 2.0 * s * s, 2.0 * s * c);
}

// Returns the cosine and the sine of a polar angle of `part` / `parts` times pi.
vec2 polarCosSin(float part, float parts)
{
    const float fromPole = min(part, parts - part);
    const vec2 cs = cosSinOfQuadrant(fromPole * (PI / parts));
    return vec2(part > fromPole ? -cs.x : cs.x, cs.y);
}

// Returns the cosine and the sine of an azimuth of (part / parts - 1/2) times 2 pi, 0 <= part <
// parts.
vec2 azimuthCosSin(float part, float parts)
{
    const float quarters = 4.0 * part / parts; // quarters of a turn from +z
    const float quarter = floor(quarters);
    const vec2 cs = cosSinOfQuadrant((quarters - quarter) * HALF_PI);
    const vec2 turned = mod(quarter, 2.0) == 1.0 ? vec2(-cs.y, cs.x) : cs;
    return quarter >= 2.0 ? turned : -turned;
}

#endif
