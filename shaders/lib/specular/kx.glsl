// SPDX-License-Identifier: Apache-2.0
// Two cheap specular methods for sphere lights: the centre as the only point, and the sphere's point
// nearest to the mirror ray with the exact peak of the lobe over the cap.
#ifndef CND_LIB_SPECULAR_KX
#define CND_LIB_SPECULAR_KX

#include "lib/brdf.glsl"
#include "lib/lights/sphere_cap.glsl"

// Returns the response if all light comes from the centre. The irradiance on a surface that faces the
// light is pi s^2 for unit luminance.
vec2 pointResponse(ShadingPoint p, SphereCap cap)
{
    return min(PI * cap.s2 * specularResponse(p, cap.c), vec2(1.0));
}

// Returns the response at the sphere's point nearest to the mirror ray, for a lobe of unchanged width.
// It is scaled by 1 / sqrt((1 + q) (1 + q / VoH^2)), q = s^2 / (4 alpha^2), which is the mean of the
// lobe over the cap, relative to its peak, if the mirror direction is in the middle of the cap. So the
// response is right there; it is too dark between the core and the tail of the lobe.
vec2 kxResponse(ShadingPoint p, SphereCap cap)
{
    const vec3 toRay = dot(cap.c, p.mirror) * p.mirror - cap.c;
    const float reach = cap.s * inversesqrt(max(length2(toRay), MIN_LENGTH2));
    const vec3 closest = cap.c + toRay * min(reach, 1.0);
    const vec3 l = closest * inversesqrt(max(length2(closest), MIN_LENGTH2));
    const float VoH2 = 0.5 * max(1.0 + dot(p.v, l), 1e-6);
    const float q = cap.s * cap.s / (4.0 * p.alpha * p.alpha);
    const float peak = inversesqrt((1.0 + q) * (1.0 + q / VoH2));
    return min(2.0 * PI * cap.omc * peak * specularResponse(p, l), vec2(1.0));
}

#endif
