// SPDX-License-Identifier: Apache-2.0
// The responses to spheres, near and distant, of unit luminance.
#include "lib/lights/sphere.glsl"
#include "lib/lights/sphere_cap.glsl"
#include "lib/specular/karis.glsl"
#include "lib/specular/kx.glsl"
#include "shading/light.glsl"

#ifdef LIGHT_FAMILY_SPHERE
// Returns the response of the specular lobe to a sphere of unit luminance, by any method except the
// closed form.
vec2 cheapSphereSpecular(Receiver r, Light light, SphereCap cap)
{
    switch (specularMethod) {
    case SPECULAR_POINT:
        return pointResponse(r.p, cap);
    case SPECULAR_KX:
        return kxResponse(r.p, cap);
    case SPECULAR_KARIS:
        return karisResponse(r.p, light.toLight,
                             inversesqrt(max(length2(light.toLight), MIN_LENGTH2)),
                             light.boundingRadius, cap.s2);
    case SPECULAR_SAMPLED:
        return sampledSphere(r.p, cap.c, cap.omc, r.sampleCount, lightSeed(r, light.index));
    }
    return vec2(0.0);
}
#endif

// Returns the response to a sphere above the horizon. The functions after it evaluate spheres across
// the horizon and near it.
vec3 sphereAbove(Receiver r, Light light)
{
    const SphereCap cap = makeSphereCap(r.p.n, light.toLight, light.boundingRadius);
#ifdef LIGHT_FAMILY_CONIC
    const vec2 specular = specularMethod == SPECULAR_CONIC ? conicAbove(r.conic, cap)
                                                           : conicUnclipped(r.conic, cap, false);
#else
    const vec2 specular = cheapSphereSpecular(r, light, cap);
#endif
    return diffuseResponse(r.p, cap.NoC * cap.s2) + schlick(r.p, specular);
}

vec3 sphereAcross(Receiver r, Light light)
{
    const SphereCap cap = makeSphereCap(r.p.n, light.toLight, light.boundingRadius);
#ifdef LIGHT_FAMILY_CONIC
    const vec2 response = conicClipped(r.conic, cap);
#else
    const vec2 response = cheapSphereSpecular(r, light, cap);
#endif
    // The cap may be below the horizon because of rounding, or if the receiver is inside the sphere.
    const vec2 specular = cap.NoC > -cap.s ? response : vec2(0.0);
    return diffuseResponse(r.p, sphereFormFactor(cap.NoC, cap.s2)) + schlick(r.p, specular);
}

#ifdef LIGHT_FAMILY_CONIC
vec3 sphereNear(Receiver r, Light light)
{
    const SphereCap cap = makeSphereCap(r.p.n, light.toLight, light.boundingRadius);
    const bool mixed = specularMethod == SPECULAR_CONIC;
    return diffuseResponse(r.p, sphereFormFactor(cap.NoC, cap.s2)) +
           schlick(r.p, conicUnclipped(r.conic, cap, mixed));
}
#endif

#define ABOVE_RESPONSE sphereAbove
#ifndef LIGHT_FAMILY_ALL
#define GENERAL_RESPONSE sphereAcross
#endif
