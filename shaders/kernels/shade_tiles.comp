// SPDX-License-Identifier: Apache-2.0
// Adds the light of each cluster's list to the scene radiance, in the tiles of a work list.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernels/common/shade_receiver.glsl"

layout(local_size_x = TILE_SIZE, local_size_y = TILE_SIZE) in;
layout(push_constant, scalar) uniform Push
{
    ShadeTilesParams params;
};

#include "kernels/common/count_lanes.glsl"
#include "kernels/common/tile_walk.glsl"
#include "shading/light_walk.glsl"

layout(binding = SHADE_RADIANCE, rgba32f) uniform image2D radianceImage;

void main()
{
    uint tile;
    uvec2 pixel;
    if (!takeTile(tile, pixel))
        return;
    const float depth = texelFetch(depthImage, ivec2(pixel), 0).x;
    if (depth == frameParams.clearDepth)
        return;
    Block block = beginWalk(tile, depth);
    if (block.count == 0u)
        return;
    const Receiver r = makeReceiver(readShadingPoint(pixel, depth), frameParams.errorBudget,
                                    frameParams.sampleCount, pixelSeed(pixel));
    Sums sums = noLight();
    do { // a lane that is done may run once more (Mesa 22.3); its block is then empty
        shadeBlock(sums, r, block.first, block.count, true);
        block = nextBlock(block);
    } while (block.count != 0u);
    const vec4 before = imageLoad(radianceImage, ivec2(pixel));
    imageStore(radianceImage, ivec2(pixel), before + vec4(total(sums), 0.0));
}
