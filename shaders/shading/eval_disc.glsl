// SPDX-License-Identifier: Apache-2.0
// The response to a disc of unit luminance.
#include "lib/lights/disc.glsl"
#include "lib/specular/representative.glsl"
#include "lib/specular/sampled.glsl"
#include "shading/light.glsl"

vec3 discResponse(Receiver r, Light given)
{
    float scale;
    const Light light = atUnitDistance(given, scale);
    const LightShape shape = lightShapes[light.index];
    const vec3 normal = shape.axisU;
    const float radius = scale * shape.radius;
    const bool twoSided = isTwoSided(shape);
    const float formFactor = discFormFactor(r.p.n, light.toLight, normal, radius, twoSided);
    vec3 response = diffuseResponse(r.p, formFactor);
    if (areaMethod == SPECULAR_KARIS)
        response += schlick(r.p, representativeDisc(r.p, light.toLight, normal, radius, twoSided));
    else if (areaMethod == SPECULAR_LTC)
        response += schlick(r.p, ltcDisc(r.ltc, light.toLight, normal, radius, twoSided));
    else if (areaMethod == SPECULAR_SAMPLED)
        response += schlick(r.p, sampledDisc(r.p, light.toLight, normal, radius, twoSided,
                                             r.sampleCount, lightSeed(r, light.index)));
    return response;
}

#ifndef LIGHT_FAMILY_ALL
#define GENERAL_RESPONSE discResponse
#endif
