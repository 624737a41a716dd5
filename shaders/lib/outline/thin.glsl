// SPDX-License-Identifier: Apache-2.0
// Widens thin lights.
//
// The terms of an outline cancel down to the light's area (outline.glsl). The thinner a light is, the
// fewer digits are left. The response to a light that is thin compared with its length, its distance
// and the lobe is proportional to its width, so such a light is made wider and dimmer by the same
// factor.
#ifndef CND_LIB_OUTLINE_THIN
#define CND_LIB_OUTLINE_THIN

#include "lib/outline/points.glsl"

// The least half width, as a share of half the length or of the distance, whichever is less, and as a
// share of that length times alpha. The highlight of a widened light is too wide by about the square of
// the second share.
const float THINNEST = 0.002, THINNEST_OF_LOBE = 0.25;

// Returns the half width with which a light is evaluated. It is `halfWidth`, unless that is too small.
// `axis`: from the centre along the light to its end.
float widened(float alpha, vec3 centre, vec3 axis, float halfWidth)
{
    const float axis2 = length2(axis);
    const vec3 nearest = centre -
        clamp(dot(centre, axis) / max(axis2, MIN_LENGTH2), -1.0, 1.0) * axis;
    const float size2 = min(axis2, length2(nearest));
    return max(halfWidth, min(THINNEST, THINNEST_OF_LOBE * alpha) * sqrt(size2));
}

// Returns the factor, at least 1, by which the shorter half axis v of a flat light is made longer.
float widening(float alpha, vec3 centre, vec3 u, vec3 v)
{
    const float width = sqrt(max(length2(v), MIN_LENGTH2));
    return max(widened(alpha, centre, u, width) / width, 1.0); // a quotient of equals may be less
}

#endif
