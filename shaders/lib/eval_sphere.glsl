// SPDX-License-Identifier: Apache-2.0
// Responses to spheres, near and distant, of unit luminance. Part of lib/light_eval.glsl.

#if HAS_FAMILY(FAMILY_SPHERE)
// Response of the specular lobe to a sphere of unit luminance; the closed form is not among these.
vec2 cheapSphereSpecular(Receiver r, Light light, SphereCap cap)
{
    switch (specularMethod) {
    case SPECULAR_POINT:
        return pointResponse(r.p, cap);
    case SPECULAR_KX:
        return kxResponse(r.p, cap);
    case SPECULAR_KARIS:
        return karisResponse(r.p, light.toLight,
                             inversesqrt(max(length2(light.toLight), MIN_LENGTH2)), light.reach,
                             cap.s2);
    case SPECULAR_LTC:
        return ltcSphere(r.ltc, cap.c, cap.s2);
    case SPECULAR_SAMPLED:
        return sampledSphere(r.p, cap.c, cap.omc, r.sampleCount, lightSeed(r, light.index));
    }
    return vec2(0.0);
}
#endif

#if HAS_SPHERES
// A sphere in the four evaluations.
vec3 sphereAsPoint(Receiver r, Light light)
{
    const SphereCap cap = makeSphereCap(r.p.n, light.toLight, light.reach);
    return r.p.albedo * (cap.NoC * cap.s2) + schlick(r.p, pointResponse(r.p, cap));
}

vec3 sphereAbove(Receiver r, Light light)
{
    const SphereCap cap = makeSphereCap(r.p.n, light.toLight, light.reach);
    vec2 specular = vec2(0.0);
#if HAS_FAMILY(FAMILY_CONIC)
    if (specularMethod == SPECULAR_CONIC)
        specular = conicAbove(r.conic, cap);
    else if (specularMethod == SPECULAR_CONIC_FULL)
        specular = conicFullUnclipped(r.conic, cap);
#endif
#if HAS_FAMILY(FAMILY_SPHERE)
    if (!IS_CONIC)
        specular = cheapSphereSpecular(r, light, cap);
#endif
    return r.p.albedo * (cap.NoC * cap.s2) + schlick(r.p, specular);
}

#if HAS_FAMILY(FAMILY_CONIC)
vec3 sphereNear(Receiver r, Light light)
{
    const SphereCap cap = makeSphereCap(r.p.n, light.toLight, light.reach);
    const bool mixed = specularMethod == SPECULAR_CONIC;
    return r.p.albedo * sphereFormFactor(cap.NoC, cap.s2) +
           schlick(r.p, conicUnclipped(r.conic, cap, mixed));
}
#endif

vec3 sphereAcross(Receiver r, Light light)
{
    const SphereCap cap = makeSphereCap(r.p.n, light.toLight, light.reach);
    vec2 specular = vec2(0.0);
#if HAS_FAMILY(FAMILY_CONIC)
    if (IS_CONIC) // a receiver inside a sphere may have its cap below the horizon
        specular = cap.NoC > -cap.s ? conicClipped(r.conic, cap) : vec2(0.0);
#endif
#if HAS_FAMILY(FAMILY_SPHERE)
    if (!IS_CONIC)
        specular = cheapSphereSpecular(r, light, cap);
#endif
    return r.p.albedo * sphereFormFactor(cap.NoC, cap.s2) + schlick(r.p, specular);
}

#endif // HAS_SPHERES
