// SPDX-License-Identifier: Apache-2.0
// Union of the bounds of a block of tiles.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/lighting.h"

layout(local_size_x = COARSE_BOUNDS_GROUP) in;
layout(push_constant, scalar) uniform Push
{
    CoarseBoundsParams params;
};
layout(scalar, binding = COARSE_BOUNDS_TILES) readonly buffer Tiles
{
    TileBounds tiles[];
};
layout(scalar, binding = COARSE_BOUNDS_COARSE) writeonly buffer Coarse
{
    TileBounds coarse[];
};

void main()
{
    const uint index = gl_GlobalInvocationID.x;
    if (index >= params.coarseCount)
        return;
    const uvec2 first =
        params.factor * uvec2(index % params.coarseCountX, index / params.coarseCountX);
    const uvec2 end = min(first + params.factor, uvec2(params.tileCountX, params.tileCountY));
    TileBounds merged = tiles[first.y * params.tileCountX + first.x];
    for (uint y = first.y; y < end.y; ++y)
        for (uint x = first.x; x < end.x; ++x) {
            const TileBounds tile = tiles[y * params.tileCountX + x];
            merged.min = min(merged.min, tile.min);
            merged.max = max(merged.max, tile.max);
        }
    coarse[index] = merged;
}
