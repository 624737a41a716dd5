// SPDX-License-Identifier: Apache-2.0
// Responses to lights without size.
#include "shading/light.glsl"

// Response to unit illuminance on a surface that faces the light, from the unit direction l.
vec3 responseFrom(ShadingPoint p, vec3 l)
{
    vec3 response = diffuseResponse(p, INV_PI * max(dot(p.n, l), 0.0));
    if (specularMethod != SPECULAR_NONE)
        response += schlick(p, specularResponse(p, l));
    return response;
}

// Response to unit intensity (point: the same everywhere; spot: on its axis).
vec3 intensityResponse(ShadingPoint p, Light light)
{
    const float d2 = max(length2(light.toLight), MIN_LENGTH2);
    const vec3 l = light.toLight * inversesqrt(d2);
    float illuminance = 1.0 / d2;
    if (lightType == LIGHT_SPOT) {
        // KHR_lights_punctual, "Inner and Outer Cone Angles".
        const LightShape spot = lightShapes[light.index];
        const float t = saturate(dot(-l, spot.axisU) * coneScale(spot) + coneOffset(spot));
        illuminance *= t * t;
    }
    return illuminance * responseFrom(p, l);
}

vec3 punctualResponse(Receiver r, Light light)
{
    return lightType == LIGHT_DIRECTIONAL ? responseFrom(r.p, light.toLight)
                                          : intensityResponse(r.p, light);
}

#ifndef LIGHT_FAMILY_ALL
#define GENERAL_RESPONSE punctualResponse
#endif
