// SPDX-License-Identifier: Apache-2.0
// The response to a tube of unit luminance.
#include "lib/outline/tube.glsl"
#include "lib/specular/representative.glsl"
#include "lib/specular/sampled.glsl"
#include "shading/by_outline.glsl"

LightResponse tubeByOutline(Receiver r, Light light, float scale, OutlineNeeds needs)
{
    const LightShape shape = lightShapes[light.index];
    const WalkedOutline walked =
        tubeOutline(r.conic, r.frame, light.toLight, scale * shape.axisU, scale * shape.radius,
                    needs);
    return outlineResponse(readAgain(r).conic, walked);
}

// Returns the response of the specular lobe by any method except the closed form.
vec2 cheapTubeSpecular(Receiver r, Light light, float scale)
{
    const LightShape shape = lightShapes[light.index];
    const vec3 axis = scale * shape.axisU;
    const float radius = scale * shape.radius;
    vec2 specular = vec2(0.0);
    if (specularMethod == SPECULAR_KARIS)
        specular = representativeTube(r.p, light.toLight, axis, radius);
    else if (specularMethod == SPECULAR_SAMPLED)
        specular = sampledTube(r.p, light.toLight, axis, radius, r.sampleCount,
                               lightSeed(r, light.index));
    return specular;
}

LightResponse tubeWithNeeds(Receiver r, Light given, OutlineNeeds needs)
{
    float scale;
    const Light light = atUnitDistance(given, scale);
    LightResponse response = tubeByOutline(r, light, scale, needs);
    if (!BY_OUTLINE)
        response.specular = cheapTubeSpecular(r, light, scale);
    return response;
}

OUTLINE_CLASSES(tube)
