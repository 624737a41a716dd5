// SPDX-License-Identifier: Apache-2.0
// The colour attachments of the raster pass, and how a surface is written to them.
#include "lib/gbuffer.glsl"
#include "shared/raster.h"

layout(constant_id = RASTER_LAYOUT) const uint gbufferLayout = 0u;

layout(location = 0) out uvec2 outNormalRoughness;
layout(location = 1) out vec4 outAlbedo;
layout(location = 2) out vec4 outRadiance; // cd/m^2
layout(location = 3) out vec4 outSpecular; // layout COMPACT has no such attachment

struct MaterialSample {
    vec3 baseColor;
    float metalness;
    float perceptualRoughness;
    vec3 dielectricF0;
    float diffuseWeight;
    float specularWeight;
    vec3 emission; // cd/m^2
};

// `normal` is a unit vector in view space.
void writeSurface(vec3 normal, MaterialSample m)
{
    outRadiance = vec4(m.emission, 1.0);
    if (gbufferLayout == GBUFFER_LAYOUT_COMPACT) {
        outNormalRoughness = uvec2(packNormalRoughnessCompact(normal, m.perceptualRoughness), 0);
        outAlbedo = vec4(m.baseColor, m.metalness);
        outSpecular = vec4(0);
    } else {
        outNormalRoughness = packNormalRoughnessFull(normal, m.perceptualRoughness);
        outAlbedo = vec4(m.baseColor * ((1.0 - m.metalness) * m.diffuseWeight), 0.0);
        outSpecular = vec4(mix(m.dielectricF0, m.baseColor, m.metalness), m.specularWeight);
    }
}

// Writes a pixel that shows an emitter: its luminance, and a surface to which lighting adds nothing.
void writeEmitter(vec3 normal, vec3 luminance)
{
    outRadiance = vec4(luminance, 1.0);
    outNormalRoughness = gbufferLayout == GBUFFER_LAYOUT_COMPACT
                             ? uvec2(NORMAL_ROUGHNESS_UNLIT_COMPACT, 0)
                             : packNormalRoughnessFull(normal, 1.0);
    outAlbedo = vec4(0);
    outSpecular = vec4(0);
}
