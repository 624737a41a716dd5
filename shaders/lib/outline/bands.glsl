// SPDX-License-Identifier: Apache-2.0
// Divides lights near the horizon into two bands.
//
// Shadowing falls to 0 at the horizon. If a light crosses the horizon, two directions that replace the
// whole light miss the mean of this fall by several percent. So such a light is cut by a plane through
// the receiver, which rises from the horizon towards the light. A second walk along the outline gives
// the integrals over the upper band. The lower band is the rest. Each band is shaded on its own
// (shading.glsl).
//
// The plane rises to BAND_HEIGHT times the highest n . l of the light. Lights wholly above the plane
// have no lower band. As a light sinks towards the horizon, its lower band grows from nothing, so the
// response has no jump.
#ifndef CND_LIB_OUTLINE_BANDS
#define CND_LIB_OUTLINE_BANDS

#include "lib/outline/outline.glsl"

// shading/classify_lights.glsl relies on this value: a light in the class `above` has no lower band.
const float BAND_HEIGHT = 0.2;

bool hasLowerBand(Outline k)
{
    return k.tilt != vec2(0.0);
}

// Closes the outline of the part of a light that has just been walked. Returns whether the upper band
// must be walked next.
bool beginUpperBand(inout Outline k)
{
    const bool isUpperBand = hasLowerBand(k);
    if (k.crosses) {
        if (isUpperBand)
            addEdge(k, pointInDirection(k, k.leaves), pointInDirection(k, k.enters));
        else
            addHorizon(k);
    }
    if (isUpperBand) {
        k.lowerDiffuse -= k.diffuse;
        k.lowerSpecular -= k.specular;
        return false;
    }
    // A light around the normal has no azimuth, so the plane sinks to the horizon before.
    const vec3 towards = unitDirection(k.diffuse);
    const float across2 = dot(towards.xy, towards.xy);
    const vec2 azimuth = inversesqrt(max(across2, MIN_LENGTH2)) * towards.xy;
    const float slanting = smoothstep(0.0, 0.05, sqrt(across2));
    // The plane is above the horizon only at azimuths that differ by less than 90 degrees from that of
    // the light. If the light crosses the horizon elsewhere, a part of it is above the plane but below
    // the horizon. So the plane sinks to the horizon before that happens, too.
    const float nearer = min(dot(azimuth, (k.lc + k.enters).xy), dot(azimuth, (k.lc + k.leaves).xy));
    const float height = BAND_HEIGHT * (k.inside ? 1.0 : clamp(k.high, 0.0, 1.0));
    const float sine = height * slanting * (k.crosses ? smoothstep(0.0, 0.3, nearer) : 1.0);
    if (!k.needs.across || !k.needs.lobe || k.low >= sine || sine < 1e-6)
        return false;
    k.tilt = -sine * azimuth;
    k.lowerDiffuse = k.diffuse;
    k.lowerSpecular = k.specular;
    k.lowerLow = max(k.low, 0.0);
    k.diffuse = vec3(0.0);
    k.specular = vec3(0.0);
    k.low = 1.0;
    k.crosses = false;
    return true;
}

#endif
