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

// A set of classes, with a bit 1 << CLASS_* for each.
const uint CLASSES_TO_FIND =
    (FINDS_DIFFUSE ? 1u << CLASS_DIFFUSE : 0u) | (FINDS_SPECULAR ? 1u << CLASS_SPECULAR : 0u);

// Returns the classes of tiles in which the surface of a pixel may lie.
uint classesWith(uvec2 pixel)
{
    const Surface s = readSurface(ivec2(pixel));
    return (isBlack(s.F0) && s.specularWeight == 0.0 ? 1u << CLASS_DIFFUSE : 0u) |
           (isBlack(s.albedo) ? 1u << CLASS_SPECULAR : 0u);
}

// Returns the class of a tile all of whose surfaces may lie in tiles of `classes`.
uint classOf(uint classes)
{
    return (classes >> CLASS_DIFFUSE & 1u) != 0u    ? CLASS_DIFFUSE
           : (classes >> CLASS_SPECULAR & 1u) != 0u ? CLASS_SPECULAR
                                                    : CLASS_ANY;
}

// Returns the class of the tile with the pixels first .. end - 1. The loop ends as soon as only
// CLASS_ANY is possible.
uint classOfTile(uvec2 first, uvec2 end)
{
    uint classes = CLASSES_TO_FIND;
    for (uint y = first.y; y < end.y && classes != 0u; ++y)
        for (uint x = first.x; x < end.x && classes != 0u; ++x)
            if (depthAt(uvec2(x, y)) != frameParams.clearDepth)
                classes &= classesWith(uvec2(x, y));
    return classOf(classes);
}

#endif
