// SPDX-License-Identifier: Apache-2.0
// Reads the part of the light data that every loop needs.
#ifndef CND_COMMON_LIGHT_STREAM
#define CND_COMMON_LIGHT_STREAM

#include "shading/software_drivers.glsl"

layout(binding = LIGHT_CORE_TEXELS) uniform textureBuffer lightTexels;
layout(scalar, binding = LIGHT_CORE) readonly buffer LightWords
{
    vec4 lightWords[];
};

// Returns the centre in view space and the bounding radius of the emitter.
vec4 lightCentre(uint light)
{
    return READ(lightWords, lightTexels, light * LIGHT_CORE_STRIDE);
}

// Returns the emission and the squared influence radius.
vec4 lightEmission(uint light)
{
    return READ(lightWords, lightTexels, light * LIGHT_CORE_STRIDE + 1u);
}

#endif
