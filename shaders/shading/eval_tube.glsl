// SPDX-License-Identifier: Apache-2.0
// The response to a tube of unit luminance.
#include "lib/lights/tube.glsl"
#include "lib/specular/representative.glsl"
#include "lib/specular/sampled.glsl"
#include "shading/light.glsl"

vec3 tubeResponse(Receiver r, Light given)
{
    float scale;
    const Light light = atUnitDistance(given, scale);
    const LightShape shape = lightShapes[light.index];
    const vec3 axis = scale * shape.axisU;
    const float radius = scale * shape.radius;
    const TubeOutline outline = makeTubeOutline(light.toLight, axis, radius);
    const float formFactor = tubeFormFactor(r.p.n, outline);
    vec3 specular = vec3(0.0);
    if (areaMethod == SPECULAR_KARIS)
        specular = schlick(r.p, representativeTube(r.p, light.toLight, axis, radius));
    else if (areaMethod == SPECULAR_LTC)
        specular = schlick(r.p, ltcTube(r.ltc, outline));
    else if (areaMethod == SPECULAR_SAMPLED)
        specular = schlick(r.p, sampledTube(r.p, light.toLight, axis, radius, r.sampleCount,
                                             lightSeed(r, light.index)));
    return diffuseResponse(r.p, formFactor) + specular;
}

#ifndef LIGHT_FAMILY_ALL
#define GENERAL_RESPONSE tubeResponse
#endif
