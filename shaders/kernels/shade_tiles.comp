// SPDX-License-Identifier: Apache-2.0
// Adds the light of each cluster's list to the scene radiance, in the tiles of a work list. A group of
// lanes takes a tile, and each lane a pixel.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernels/common/shade_receiver.glsl"

layout(local_size_x = TILE_SIZE, local_size_y = TILE_SIZE) in;
layout(push_constant, scalar) uniform Push
{
    ShadeTilesParams params;
};

#include "kernels/common/tile_walk.glsl"
#ifdef SHADOWS
#include "kernels/common/visible_shares_at.glsl"
#endif
#define MAY_READ_AHEAD true
#define KEPT_LANES (TILE_SIZE * TILE_SIZE)
#define LANES_OF_RECEIVER 1u
#include "shading/light_walk.glsl"

#include "kernels/common/add_radiance.glsl"

Receiver receiverAt(uvec2 pixel, float depth)
{
    return makeReceiver(readShadingPoint(pixel, depth), frameParams.sampleCount, pixelSeed(pixel));
}

// Each lane evaluates all lights of its pixel.
void shade(uint tile, uvec2 pixel, float depth)
{
    Block block = beginWalk(params.batch, tile, depth);
    if (block.count == 0u)
        return;
    const Receiver r = receiverAt(pixel, depth);
    const uint packedPixel = pixel.y << 16 | pixel.x; // in one register instead of two
    keep(r);
    Sums sums = noLight();
    do {
        shadeBlock(sums, r, block.first, block.count, true);
        block = nextBlock(params.batch, block);
    } while (block.count != 0u);
    addRadiance(uvec2(packedPixel & 0xFFFFu, packedPixel >> 16), total(sums));
}

void main()
{
    uint tile;
    uvec2 pixel;
    if (!takeTile(tile, pixel))
        return;
#ifdef SHADOWS
    walkedTile = tile;
#endif
    const float depth = texelFetch(depthImage, depthTexelOf(pixel), 0).x;
    if (depth != frameParams.clearDepth)
        shade(tile, pixel, depth);
}
