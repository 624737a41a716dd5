// SPDX-License-Identifier: Apache-2.0
// Reads the materials of meshes.
#ifndef CND_GBUFFER_MATERIAL_RECORD
#define CND_GBUFFER_MATERIAL_RECORD

#include "gbuffer/material.glsl"
#include "shared/raster.h"

layout(binding = MESH_MATERIALS) uniform textureBuffer materials;

vec4 materialTexel(uint material, uint texel)
{
    return texelFetch(materials, int(material * MATERIAL_TEXELS + texel));
}

// Returns a material without its textures.
MaterialSample plainMaterial(uint material)
{
    const vec4 base = materialTexel(material, 0u);
    const vec4 rough = materialTexel(material, 1u);
    const vec4 dielectric = materialTexel(material, 2u);
    const vec4 emission = materialTexel(material, 3u);
    return MaterialSample(base.rgb, rough.x, rough.y, dielectric.rgb, dielectric.w, emission.w,
                          emission.rgb);
}

#endif
