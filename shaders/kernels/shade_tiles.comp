// SPDX-License-Identifier: Apache-2.0
// Adds the light of each cluster's list to the scene radiance, in the tiles of a work list. A group of
// lanes takes a tile, and each lane a pixel.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernels/common/shade_receiver.glsl"

layout(local_size_x = TILE_SIZE, local_size_y = TILE_SIZE) in;
layout(constant_id = SPEC_TILE_HEIGHT) const uint tileHeight = ANY_HEIGHT;
layout(push_constant, scalar) uniform Push
{
    ShadeTilesParams params;
};

#include "kernels/common/tile_walk.glsl"
// shading/kept_receiver.glsl, which light_walk.glsl includes, declares lanesTogether.
#define READS_AHEAD lanesTogether
#define TILE_HEIGHT tileHeight
#define KEPT_RECEIVERS (TILE_SIZE * TILE_SIZE)
#define KEPT_RECEIVER gl_LocalInvocationIndex
#define KEPT_LANES KEPT_RECEIVERS
#include "shading/light_walk.glsl"

#define RADIANCE_IMAGE SHADE_RADIANCE
#include "kernels/common/add_radiance.glsl"

Receiver receiverAt(uvec2 pixel, float depth)
{
    return makeReceiver(readShadingPoint(pixel, depth), frameParams.sampleCount, pixelSeed(pixel));
}

// Each lane evaluates all lights of its pixel.
void shade(uint tile, uvec2 pixel, float depth)
{
    Block block = beginWalk(tile, depth);
    if (block.count == 0u)
        return;
    const Receiver r = receiverAt(pixel, depth);
    const uint packedPixel = pixel.y << 16 | pixel.x; // in one register instead of two
    keep(r);
    Sums sums = noLight();
    do { // a lane that is done may run once more (Mesa 22.3); its block is then empty
        shadeBlock(sums, r, block.first, block.count, true);
        block = nextBlock(block);
    } while (block.count != 0u);
    addRadiance(ivec2(packedPixel & 0xFFFFu, packedPixel >> 16), total(sums));
}

void main()
{
    uint tile;
    uvec2 pixel;
    if (!takeTile(tileHeight, tile, pixel))
        return;
    const float depth = texelFetch(depthImage, ivec2(pixel), 0).x;
    if (depth != frameParams.clearDepth)
        shade(tile, pixel, depth);
}
