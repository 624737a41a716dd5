// SPDX-License-Identifier: Apache-2.0
// The representative point of a sphere light (Karis 2013, "Real Shading in Unreal Engine 4"), with the
// normalisation (alpha / alpha')^2, alpha' = min(alpha + R / (2 d), 1).
#ifndef CND_LIB_SPECULAR_KARIS
#define CND_LIB_SPECULAR_KARIS

#include "lib/brdf.glsl"

// Returns the response (F = 1, F = (1 - VoH)^5) of the lobe to a sphere of unit luminance. `toLight`:
// from the point to the centre; the distance d is 1 / invDistance; s2 = min((R / d)^2, 1). It deviates
// from Karis in one respect: NoL is taken at the representative point instead of the centre, which is
// more accurate.
vec2 karisResponse(ShadingPoint p, vec3 toLight, float invDistance, float radius, float s2)
{
    const vec3 centreToRay = dot(toLight, p.mirror) * p.mirror - toLight;
    // The floor avoids 0 / 0 if the mirror ray goes through the centre.
    const float reach = radius * inversesqrt(max(length2(centreToRay), MIN_LENGTH2));
    const vec3 closest = toLight + centreToRay * min(reach, 1.0);
    const vec3 l = closest * inversesqrt(max(length2(closest), MIN_LENGTH2));
    const float widened = min(p.alpha + 0.5 * radius * invDistance, 1.0);
    const float narrowing = p.alpha / widened;
    return PI * s2 * narrowing * narrowing * specularResponse(p, l);
}

#endif
