// SPDX-License-Identifier: Apache-2.0
// Bindings and G-buffer reading shared by the kernels that walk lights per pixel.
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/lighting.h"
#include "lib/gbuffer.glsl"
#include "lib/brdf.glsl"
#include "lib/projection.glsl"
#define LIGHT_STREAM_CORE SHADE_CORE
#define LIGHT_STREAM_CORE_WORDS SHADE_CORE_WORDS
#include "lib/light_stream.glsl"

layout(constant_id = SPEC_GBUFFER_LAYOUT) const uint gbufferLayout = 0u;
layout(push_constant, scalar) uniform Push
{
    ShadeParams params;
};
layout(scalar, binding = SHADE_AUX) readonly buffer Aux
{
    vec4 lightAux[];
};
layout(binding = SHADE_NORMAL_ROUGHNESS) uniform utexture2D normalRoughnessImage;
layout(binding = SHADE_ALBEDO) uniform texture2D albedoImage;
layout(binding = SHADE_SPECULAR) uniform texture2D specularImage;
layout(binding = SHADE_DEPTH) uniform texture2D depthImage;

Surface readSurface(ivec2 pixel)
{
    const uvec2 normalRoughness = texelFetch(normalRoughnessImage, pixel, 0).xy;
    const vec4 albedo = texelFetch(albedoImage, pixel, 0);
    if (gbufferLayout == GBUFFER_LAYOUT_COMPACT)
        return unpackGBufferCompact(normalRoughness.x, albedo);
    return unpackGBufferFull(normalRoughness, albedo, texelFetch(specularImage, pixel, 0));
}
