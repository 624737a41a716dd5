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
LightResponse sphereAbove(Receiver r, Light light)
{
    const SphereCap cap = makeSphereCap(r.p.n, light.toLight, light.boundingRadius);
    const vec2 specular = specularMethod == SPECULAR_CONIC ? conicAbove(r.conic, cap)
                                                           : conicUnclipped(r.conic, cap, false);
    return LightResponse(cap.NoC * cap.s2, specular);
}

LightResponse sphereNear(Receiver r, Light light)
{
    const SphereCap cap = makeSphereCap(r.p.n, light.toLight, light.boundingRadius);
    const bool mixed = specularMethod == SPECULAR_CONIC;
    return LightResponse(sphereFormFactor(cap.NoC, cap.s2), conicUnclipped(r.conic, cap, mixed));
}

// Returns the response to a sphere across the horizon. The cap may be below the horizon because of
// rounding, or if the receiver is inside the sphere.
LightResponse responseAcross(SphereCap cap, vec2 specular)
{
    return LightResponse(sphereFormFactor(cap.NoC, cap.s2),
                         cap.NoC > -cap.s ? specular : vec2(0.0));
}

LightResponse sphereAcross(Receiver r, Light light)
{
    const SphereCap cap = makeSphereCap(r.p.n, light.toLight, light.boundingRadius);
    return responseAcross(cap, conicClipped(r.conic, cap));
}

LightResponse cheapSphereAbove(Receiver r, Light light)
{
    const SphereCap cap = makeSphereCap(r.p.n, light.toLight, light.boundingRadius);
    return LightResponse(cap.NoC * cap.s2, cheapSphereSpecular(r, light, cap));
}

LightResponse cheapSphereAcross(Receiver r, Light light)
{
    const SphereCap cap = makeSphereCap(r.p.n, light.toLight, light.boundingRadius);
    return responseAcross(cap, cheapSphereSpecular(r, light, cap));
}
