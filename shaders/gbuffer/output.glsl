// SPDX-License-Identifier: Apache-2.0
// The colour attachments of the raster pass, and how a surface is written to them. Compiled with
// FULL or COMPACT, the layout. Radiance is written only with EMISSIVE: the pass first draws surfaces
// that emit nothing, without the attachment for radiance.
#include "gbuffer/material.glsl"
#include "lib/gbuffer.glsl"
#include "shared/raster.h"

#ifdef COMPACT
layout(location = 0) out uint outNormalRoughness;
layout(location = 1) out vec4 outAlbedo;
#define RADIANCE_LOCATION 2
#else
layout(location = 0) out uvec2 outNormalRoughness;
layout(location = 1) out uvec2 outAlbedo;
layout(location = 2) out uvec2 outSpecular;
#define RADIANCE_LOCATION 3
#endif
#ifdef EMISSIVE
layout(location = RADIANCE_LOCATION) out vec4 outRadiance; // cd/m^2
#endif

// `normal` is in view space. Its length may be anything from 2^-99 to 2^99.
void writeSurface(vec3 normal, MaterialSample m)
{
#ifdef EMISSIVE
    outRadiance = vec4(m.emission, 1.0);
#endif
#ifdef COMPACT
    outNormalRoughness = packNormalRoughnessCompact(normal, m.perceptualRoughness);
    outAlbedo = vec4(m.baseColor, m.metalness);
#else
    outNormalRoughness = packNormalRoughnessFull(normal, m.perceptualRoughness);
    outAlbedo = packAlbedoFull(diffuseAlbedo(m));
    outSpecular = packSpecularFull(normalReflectance(m), m.specularWeight);
#endif
}

#ifdef EMISSIVE
// Writes a pixel that shows an emitter: its luminance, and a surface to which lighting adds nothing.
void writeEmitter(vec3 normal, vec3 luminance)
{
    outRadiance = vec4(luminance, 1.0);
#ifdef COMPACT
    outNormalRoughness = NORMAL_ROUGHNESS_UNLIT_COMPACT;
    outAlbedo = vec4(0);
#else
    outNormalRoughness = packNormalRoughnessFull(normal, 1.0);
    outAlbedo = uvec2(0);
    outSpecular = uvec2(0);
#endif
}

// Writes a pixel without a surface.
void writeBackground(vec3 luminance)
{
    outRadiance = vec4(luminance, 1.0);
#ifdef COMPACT
    outNormalRoughness = 0u;
    outAlbedo = vec4(0);
#else
    outNormalRoughness = uvec2(0);
    outAlbedo = uvec2(0);
    outSpecular = uvec2(0);
#endif
}
#endif
