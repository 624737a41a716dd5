// SPDX-License-Identifier: Apache-2.0
// Finds the class of a tile: whether none of its surfaces has a specular lobe. The includer provides
// depthAt() and includes kernels/common/read_gbuffer.glsl for the whole G-buffer.
#ifndef CND_COMMON_TILE_CLASS
#define CND_COMMON_TILE_CLASS

#include "shared/lighting_data.h"

layout(constant_id = SPEC_FINDS_DIFFUSE) const bool findsDiffuse = false;

// Tells whether the surface of a pixel has no specular lobe. A NaN is not 0, so a surface with a NaN
// has the lobe.
bool isDiffuse(uvec2 pixel)
{
    const Surface s = readSurface(ivec2(pixel));
    return s.F0.x == 0.0 && s.F0.y == 0.0 && s.F0.z == 0.0 && s.specularWeight == 0.0;
}

uint classOf(bool diffuse)
{
    return diffuse ? CLASS_DIFFUSE : CLASS_ANY;
}

// Returns the class of the tile with the pixels first .. end - 1. The loop ends at the first surface
// with a specular lobe.
uint classOfTile(uvec2 first, uvec2 end)
{
    bool diffuse = findsDiffuse;
    for (uint y = first.y; y < end.y && diffuse; ++y)
        for (uint x = first.x; x < end.x && diffuse; ++x)
            if (depthAt(uvec2(x, y)) != frameParams.clearDepth)
                diffuse = isDiffuse(uvec2(x, y));
    return classOf(diffuse);
}

#endif
