// SPDX-License-Identifier: Apache-2.0
// Classes of lights that are evaluated by their outlines. classify_lights.glsl sorts lights into them.
#ifndef CND_SHADING_BY_OUTLINE
#define CND_SHADING_BY_OUTLINE

#include "shading/kept_receiver.glsl"
#include "shading/light.glsl"

// Any light, and lights above the horizon whose arcs are not cut.
#define OUTLINE_GENERAL OutlineNeeds(true, BY_OUTLINE, BY_OUTLINE, KEEPS_RECEIVERS)
#define OUTLINE_ABOVE OutlineNeeds(false, BY_OUTLINE, false, KEEPS_RECEIVERS)

// Defines the functions by which a shape is evaluated in its classes, from <shape>WithNeeds.
#define OUTLINE_CLASSES(shape)                                                                     \
    LightResponse shape##Response(Receiver r, Light light)                                         \
    {                                                                                              \
        return shape##WithNeeds(r, light, OUTLINE_GENERAL);                                        \
    }                                                                                              \
    LightResponse shape##Above(Receiver r, Light light)                                            \
    {                                                                                              \
        return shape##WithNeeds(r, light, OUTLINE_ABOVE);                                          \
    }

#endif
