// SPDX-License-Identifier: Apache-2.0
// Cheap specular methods of sphere lights beside Karis: the centre alone, and the point of the sphere
// next to the mirror ray with the exact peak of the lobe over the cap.
#ifndef CND_LIB_SPECULAR_KX
#define CND_LIB_SPECULAR_KX

#include "lib/brdf.glsl"
#include "lib/lights/sphere_cap.glsl"

// All light from the centre: irradiance pi s^2 on a surface facing it.
vec2 pointResponse(ShadingPoint p, SphereCap cap)
{
    return min(PI * cap.s2 * specularResponse(p, cap.c), vec2(1.0));
}

// The lobe keeps its width; with the mirror direction in the middle of the cap, its integral over the
// conic is that of the unwidened peak times 1 / sqrt((1 + q) (1 + q / VoH^2)), q = s^2 / (4 alpha^2):
// right by construction there, too dark between core and tail.
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
