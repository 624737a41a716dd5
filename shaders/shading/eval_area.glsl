// SPDX-License-Identifier: Apache-2.0
// Responses to tubes, rectangles and discs of unit luminance. Part of shading/light_eval.glsl.

#if HAS_TUBES || HAS_RECTANGLES || HAS_DISCS
// Responses do not depend on the scale, and at a distance of about 1 no product of lengths overflows.
Light atUnitDistance(Light light, out float scale)
{
    scale = inversesqrt(max(length2(light.toLight) + light.reach * light.reach, MIN_LENGTH2));
    light.toLight *= scale;
    light.reach *= scale;
    return light;
}
#endif

#if HAS_TUBES
vec3 tubeResponse(Receiver r, Light given)
{
    float scale;
    const Light light = atUnitDistance(given, scale);
    const vec4 axisRadius = scale * lightAux[light.index * LIGHT_AUX_STRIDE];
    const vec3 axis = axisRadius.xyz;
    const float radius = axisRadius.w;
    const TubeOutline outline = makeTubeOutline(light.toLight, axis, radius);
    vec3 response = diffuseResponse(r.p, tubeFormFactor(r.p.n, outline));
    if (areaMethod == SPECULAR_KARIS)
        response += schlick(r.p, representativeTube(r.p, light.toLight, axis, radius));
    else if (areaMethod == SPECULAR_LTC)
        response += schlick(r.p, ltcTube(r.ltc, outline));
    else if (areaMethod == SPECULAR_SAMPLED)
        response += schlick(r.p, sampledTube(r.p, light.toLight, axis, radius, r.sampleCount,
                                             lightSeed(r, light.index)));
    return response;
}

#endif

#if HAS_RECTANGLES
vec3 rectangleResponse(Receiver r, Light given)
{
    float scale;
    const Light light = atUnitDistance(given, scale);
    const vec3 u = scale * lightAux[light.index * LIGHT_AUX_STRIDE].xyz;
    const vec4 second = lightAux[light.index * LIGHT_AUX_STRIDE + 1u];
    const vec3 v = scale * second.xyz;
    const bool twoSided = second.w != 0.0;
    vec3 response = diffuseResponse(r.p, rectangleFormFactor(r.p.n, light.toLight, u, v, twoSided));
    if (areaMethod == SPECULAR_KARIS)
        response += schlick(r.p, representativeRectangle(r.p, light.toLight, u, v, twoSided));
    else if (areaMethod == SPECULAR_LTC)
        response += schlick(r.p, ltcRectangle(r.ltc, light.toLight, u, v, twoSided));
    else if (areaMethod == SPECULAR_SAMPLED)
        response += schlick(r.p, sampledRectangle(r.p, light.toLight, u, v, twoSided, r.sampleCount,
                                                  lightSeed(r, light.index)));
    return response;
}

#endif

#if HAS_DISCS
vec3 discResponse(Receiver r, Light given)
{
    float scale;
    const Light light = atUnitDistance(given, scale);
    const vec3 normal = lightAux[light.index * LIGHT_AUX_STRIDE].xyz;
    const bool twoSided = lightAux[light.index * LIGHT_AUX_STRIDE + 1u].w != 0.0;
    const float formFactor = discFormFactor(r.p.n, light.toLight, normal, light.reach, twoSided);
    vec3 response = diffuseResponse(r.p, formFactor);
    if (areaMethod == SPECULAR_KARIS)
        response += schlick(r.p, representativeDisc(r.p, light.toLight, normal, light.reach, twoSided));
    else if (areaMethod == SPECULAR_LTC)
        response += schlick(r.p, ltcDisc(r.ltc, light.toLight, normal, light.reach, twoSided));
    else if (areaMethod == SPECULAR_SAMPLED)
        response += schlick(r.p, sampledDisc(r.p, light.toLight, normal, light.reach, twoSided,
                                             r.sampleCount, lightSeed(r, light.index)));
    return response;
}

#endif
