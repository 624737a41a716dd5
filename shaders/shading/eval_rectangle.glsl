// SPDX-License-Identifier: Apache-2.0
// The response to a rectangle of unit luminance.
#include "lib/lights/rectangle.glsl"
#include "lib/specular/representative.glsl"
#include "lib/specular/sampled.glsl"
#include "shading/light.glsl"

vec3 rectangleResponse(Receiver r, Light given)
{
    float scale;
    const Light light = atUnitDistance(given, scale);
    const LightShape shape = lightShapes[light.index];
    const vec3 u = scale * shape.axisU;
    const vec3 v = scale * shape.axisV;
    const bool twoSided = isTwoSided(shape);
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

#ifndef LIGHT_FAMILY_ALL
#define GENERAL_RESPONSE rectangleResponse
#endif
