// SPDX-License-Identifier: Apache-2.0
// Karis 2013, "Real Shading in Unreal Engine 4": representative point of a sphere light, with the
// normalisation (alpha / alpha')^2, alpha' = min(alpha + R / (2 d), 1).
#ifndef CND_LIB_SPECULAR_KARIS
#define CND_LIB_SPECULAR_KARIS

#include "lib/brdf.glsl"

// Response (F = 1, F = (1 - VoH)^5) of the lobe to a sphere of unit luminance: centre `toLight` from
// the point, distance 1 / invDistance, radius R, s2 = min((R / d)^2, 1). Deviation: NoL is that of
// the representative point, which errs less than that of the centre.
vec2 karisResponse(ShadingPoint p, vec3 toLight, float invDistance, float radius, float s2)
{
    const vec3 centreToRay = dot(toLight, p.mirror) * p.mirror - toLight;
    // The mirror ray through the centre gives 0 / 0 in the usual form; rsqrt of a floor does not.
    const float reach = radius * inversesqrt(max(length2(centreToRay), MIN_LENGTH2));
    const vec3 closest = toLight + centreToRay * min(reach, 1.0);
    const vec3 l = closest * inversesqrt(max(length2(closest), MIN_LENGTH2));
    const float widened = min(p.alpha + 0.5 * radius * invDistance, 1.0);
    const float narrowing = p.alpha / widened;
    return PI * s2 * narrowing * narrowing * specularResponse(p, l);
}

#endif
