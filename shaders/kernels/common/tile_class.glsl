// SPDX-License-Identifier: Apache-2.0
// Finds the class of a tile: which lobe none of its surfaces has. The includer provides depthAt() and
// includes kernels/common/read_gbuffer.glsl for the whole G-buffer.
#ifndef CND_COMMON_TILE_CLASS
#define CND_COMMON_TILE_CLASS

#include "shared/lighting.h"

layout(constant_id = SPEC_TILE_CLASSES) const uint tileClasses = 0u;
const bool FINDS_DIFFUSE = (tileClasses >> CLASS_DIFFUSE & 1u) != 0u;
const bool FINDS_SPECULAR = (tileClasses >> CLASS_SPECULAR & 1u) != 0u;

// Tells whether a colour is 0. A NaN is not 0, so a surface with a NaN has the lobe.
bool isBlack(vec3 colour)
{
    return colour.x == 0.0 && colour.y == 0.0 && colour.z == 0.0;
}

// Returns the class of the pixels first .. end - 1. The loop ends as soon as only CLASS_ANY is
// possible.
uint classOfSurfaces(uvec2 first, uvec2 end)
{
    bool diffuse = FINDS_DIFFUSE, specular = FINDS_SPECULAR;
    for (uint y = first.y; y < end.y && (diffuse || specular); ++y)
        for (uint x = first.x; x < end.x && (diffuse || specular); ++x) {
            if (depthAt(uvec2(x, y)) == frameParams.clearDepth)
                continue;
            const Surface s = readSurface(ivec2(x, y));
            diffuse = diffuse && isBlack(s.F0) && s.specularWeight == 0.0;
            specular = specular && isBlack(s.albedo);
        }
    return diffuse ? CLASS_DIFFUSE : specular ? CLASS_SPECULAR : CLASS_ANY;
}

#endif
