// SPDX-License-Identifier: Apache-2.0
// The responses to punctual lights.
#include "shading/light.glsl"

// Returns the response to a light in the unit direction l that gives a surface facing it this
// illuminance.
LightResponse responseFrom(ShadingPoint p, vec3 l, float illuminance)
{
    LightResponse response =
        LightResponse(illuminance * (INV_PI * max(dot(p.n, l), 0.0)), vec2(0.0));
    if (specularMethod != SPECULAR_NONE)
        response.specular = illuminance * specularResponse(p, l);
    return response;
}

// Returns the response to a light of unit intensity: in all directions (point) or on its axis (spot).
LightResponse intensityResponse(ShadingPoint p, Light light)
{
    const float d2 = max(length2(light.toLight), MIN_LENGTH2);
    const vec3 l = light.toLight * inversesqrt(d2);
    float illuminance = 1.0 / d2;
    if (lightType == LIGHT_SPOT)
        illuminance *= coneAttenuation(lightShapes[light.index], -l);
    return responseFrom(p, l, illuminance);
}

LightResponse punctualResponse(Receiver r, Light light)
{
    return lightType == LIGHT_DIRECTIONAL ? responseFrom(r.p, light.toLight, 1.0)
                                          : intensityResponse(r.p, light);
}
