// SPDX-License-Identifier: Apache-2.0
// The response to a rectangle of unit luminance.
#include "lib/outline/rectangle.glsl"
#include "lib/specular/representative.glsl"
#include "lib/specular/sampled.glsl"
#include "shading/by_outline.glsl"

LightResponse rectangleByOutline(Receiver r, Light light, float scale, OutlineNeeds needs)
{
    const LightShape shape = lightShapes[light.index];
    const WalkedOutline walked =
        rectangleOutline(r.conic, r.frame, light.toLight, scale * shape.axisU,
                         scale * shape.axisV, isTwoSided(shape), needs);
    return outlineResponse(readAgain(r).conic, walked);
}

// Returns the response of the specular lobe by any method except the closed form.
vec2 cheapRectangleSpecular(Receiver r, Light light, float scale)
{
    const LightShape shape = lightShapes[light.index];
    const vec3 u = scale * shape.axisU;
    const vec3 v = scale * shape.axisV;
    const bool twoSided = isTwoSided(shape);
    vec2 specular = vec2(0.0);
    if (specularMethod == SPECULAR_KARIS)
        specular = representativeRectangle(r.p, light.toLight, u, v, twoSided);
    else if (specularMethod == SPECULAR_SAMPLED)
        specular = sampledRectangle(r.p, light.toLight, u, v, twoSided, r.sampleCount,
                                    lightSeed(r, light.index));
    return specular;
}

LightResponse rectangleWithNeeds(Receiver r, Light given, OutlineNeeds needs)
{
    float scale;
    const Light light = atUnitDistance(given, scale);
    LightResponse response = rectangleByOutline(r, light, scale, needs);
    if (!BY_OUTLINE)
        response.specular = cheapRectangleSpecular(r, light, scale);
    return response;
}

OUTLINE_CLASSES(rectangle)
