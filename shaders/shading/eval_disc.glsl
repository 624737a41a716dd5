// SPDX-License-Identifier: Apache-2.0
// The response to a disc of unit luminance.
#include "lib/outline/disc.glsl"
#include "lib/specular/representative.glsl"
#include "lib/specular/sampled.glsl"
#include "shading/by_outline.glsl"

LightResponse discByOutline(Receiver r, Light light, float scale, OutlineNeeds needs)
{
    const LightShape shape = lightShapes[light.index];
    const WalkedOutline walked =
        discOutline(r.conic, r.frame, light.toLight, shape.axisU, scale * shape.radius,
                    isTwoSided(shape), needs);
    return outlineResponse(readAgain(r).conic, walked);
}

// Returns the response of the specular lobe by any method except the closed form.
vec2 cheapDiscSpecular(Receiver r, Light light, float scale)
{
    const LightShape shape = lightShapes[light.index];
    const float radius = scale * shape.radius;
    const bool twoSided = isTwoSided(shape);
    vec2 specular = vec2(0.0);
    if (specularMethod == SPECULAR_KARIS)
        specular = representativeDisc(r.p, light.toLight, shape.axisU, radius, twoSided);
    else if (specularMethod == SPECULAR_SAMPLED)
        specular = sampledDisc(r.p, light.toLight, shape.axisU, radius, twoSided, r.sampleCount,
                               lightSeed(r, light.index));
    return specular;
}

LightResponse discWithNeeds(Receiver r, Light given, OutlineNeeds needs)
{
    float scale;
    const Light light = atUnitDistance(given, scale);
    LightResponse response = discByOutline(r, light, scale, needs);
    if (!BY_OUTLINE)
        response.specular = cheapDiscSpecular(r, light, scale);
    return response;
}

OUTLINE_CLASSES(disc)
