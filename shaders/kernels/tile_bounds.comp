// SPDX-License-Identifier: Apache-2.0
// View-space bounds of the surface samples in each 8x8 pixel tile: exact positions, not a frustum
// slice, so lights are culled against what is really there.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "lib/projection.glsl"

layout(local_size_x = TILE_BOUNDS_GROUP) in;
layout(push_constant, scalar) uniform Push
{
    TileBoundsParams params;
};
layout(binding = TILE_BOUNDS_DEPTH) uniform texture2D depthImage;
layout(scalar, binding = TILE_BOUNDS_BOUNDS) writeonly buffer Bounds
{
    TileBounds bounds[];
};
layout(scalar, binding = TILE_BOUNDS_COUNTERS) buffer Counters
{
    LightingCounters counters;
};

void main()
{
    const uint tile = gl_GlobalInvocationID.x;
    if (tile >= params.tileCount)
        return;
    const uvec2 first = TILE_SIZE * uvec2(tile % params.tileCountX, tile / params.tileCountX);
    const uvec2 end = min(first + TILE_SIZE, params.size);
    vec3 lowest = vec3(uintBitsToFloat(0x7F800000u)); // +infinity
    vec3 highest = -lowest;
    for (uint y = first.y; y < end.y; ++y)
        for (uint x = first.x; x < end.x; ++x) {
            const float depth = texelFetch(depthImage, ivec2(x, y), 0).x;
            const vec3 p = viewPosition(params.projection, uvec2(x, y), params.invImageSize, depth);
            const bool surface = depth != params.clearDepth;
            lowest = surface ? min(lowest, p) : lowest;
            highest = surface ? max(highest, p) : highest;
        }
    bounds[tile] = TileBounds(lowest, highest);
    if (lowest.x <= highest.x)
        atomicAdd(counters.surfaceTiles, 1u);
}
