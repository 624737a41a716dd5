// SPDX-License-Identifier: Apache-2.0
// The responses to spheres, near and distant, of unit luminance.
#include "lib/lights/sphere.glsl"
#include "lib/lights/sphere_cap.glsl"
#include "lib/specular/karis.glsl"
#include "lib/specular/kx.glsl"
#include "shading/light.glsl"

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

// Returns the response to a sphere above the horizon, by the closed form. The functions after it
// evaluate spheres near the horizon and across it, and spheres by the other methods.
vec3 sphereAbove(Receiver r, Light light)
{
    const SphereCap cap = makeSphereCap(r.p.n, light.toLight, light.boundingRadius);
    const vec2 specular = specularMethod == SPECULAR_CONIC ? conicAbove(r.conic, cap)
                                                           : conicUnclipped(r.conic, cap, false);
    return diffuseResponse(r.p, cap.NoC * cap.s2) + schlick(r.p, specular);
}

vec3 sphereNear(Receiver r, Light light)
{
    const SphereCap cap = makeSphereCap(r.p.n, light.toLight, light.boundingRadius);
    const bool mixed = specularMethod == SPECULAR_CONIC;
    return diffuseResponse(r.p, sphereFormFactor(cap.NoC, cap.s2)) +
           schlick(r.p, conicUnclipped(r.conic, cap, mixed));
}

// Returns the response to a sphere across the horizon. The cap may be below the horizon because of
// rounding, or if the receiver is inside the sphere.
vec3 responseAcross(Receiver r, SphereCap cap, vec2 response)
{
    const vec2 specular = cap.NoC > -cap.s ? response : vec2(0.0);
    return diffuseResponse(r.p, sphereFormFactor(cap.NoC, cap.s2)) + schlick(r.p, specular);
}

vec3 sphereAcross(Receiver r, Light light)
{
    const SphereCap cap = makeSphereCap(r.p.n, light.toLight, light.boundingRadius);
    return responseAcross(r, cap, conicClipped(r.conic, cap));
}

vec3 cheapSphereAbove(Receiver r, Light light)
{
    const SphereCap cap = makeSphereCap(r.p.n, light.toLight, light.boundingRadius);
    return diffuseResponse(r.p, cap.NoC * cap.s2) + schlick(r.p, cheapSphereSpecular(r, light, cap));
}

vec3 cheapSphereAcross(Receiver r, Light light)
{
    const SphereCap cap = makeSphereCap(r.p.n, light.toLight, light.boundingRadius);
    return responseAcross(r, cap, cheapSphereSpecular(r, light, cap));
}
