// SPDX-License-Identifier: Apache-2.0
// Classes of lights that are evaluated by their outlines. light_walk.glsl sorts lights into them.
#ifndef CND_SHADING_BY_OUTLINE
#define CND_SHADING_BY_OUTLINE

#include "shading/kept_receiver.glsl"
#include "shading/light.glsl"

// Any light; lights above the horizon whose arcs are not cut; and small lights well above the horizon,
// if an error budget allows to evaluate their specular response at one point.
#define OUTLINE_GENERAL OutlineNeeds(true, BY_OUTLINE, BY_OUTLINE, KEEPS_RECEIVERS)
#define OUTLINE_ABOVE OutlineNeeds(false, BY_OUTLINE, false, KEEPS_RECEIVERS)
#define OUTLINE_AS_POINT OutlineNeeds(false, false, false, KEEPS_RECEIVERS)

// Returns the response of the specular lobe to a light with this outline. As a point, the light has the
// same irradiance and comes from the direction of its centre.
vec2 outlineSpecular(Receiver r, Light light, OutlineResponse o, OutlineNeeds needs)
{
    const vec3 l = light.toLight * inversesqrt(max(length2(light.toLight), MIN_LENGTH2));
    const float solidAngle = PI * o.formFactor / max(dot(r.p.n, l), 1e-6);
    return needs.lobe ? o.specular : min(solidAngle * specularResponse(r.p, l), vec2(1.0));
}

// Defines the functions by which a shape is evaluated in its classes, from <shape>WithNeeds.
#define OUTLINE_CLASSES(shape)                                                                     \
    vec3 shape##Response(Receiver r, Light light)                                                  \
    {                                                                                              \
        return shape##WithNeeds(r, light, OUTLINE_GENERAL);                                        \
    }                                                                                              \
    vec3 shape##Above(Receiver r, Light light)                                                     \
    {                                                                                              \
        return shape##WithNeeds(r, light, OUTLINE_ABOVE);                                          \
    }                                                                                              \
    vec3 shape##AsPoint(Receiver r, Light light)                                                   \
    {                                                                                              \
        return shape##WithNeeds(r, light, OUTLINE_AS_POINT);                                       \
    }

#endif
