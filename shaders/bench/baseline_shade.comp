// SPDX-License-Identifier: Apache-2.0
// shade_tiles.comp for the lists of a baseline.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/tile_pixels.glsl"
#include "kernels/common/shade_receiver.glsl"
#include "bench/baseline_walk.glsl"
#include "shading/light_walk.glsl"

layout(local_size_x = TILE_SIZE, local_size_y = TILE_SIZE) in;
layout(binding = RADIANCE_IMAGE, rgba32f) uniform image2D radianceImage;

void main()
{
    const uvec2 pixel = TILE_SIZE * gl_WorkGroupID.xy + pixelOfLane(gl_LocalInvocationIndex);
    if (any(greaterThanEqual(pixel, frameParams.size)))
        return;
    const float depth = texelFetch(depthImage, ivec2(pixel), 0).x;
    if (depth == frameParams.clearDepth)
        return;
    const ShadingPoint p = readShadingPoint(pixel, depth);
    Block block = beginWalk(pixel, -p.position.z);
    if (block.count == 0u)
        return;
    const Receiver r = makeReceiver(p, frameParams.sampleCount, pixelSeed(pixel));
    Sums sums = noLight();
    do {
        shadeBlock(sums, r, block.first, block.count, true);
        block = nextBlock(block);
    } while (block.count != 0u);
    const vec4 before = imageLoad(radianceImage, ivec2(pixel));
    imageStore(radianceImage, ivec2(pixel), before + vec4(total(sums), 0.0));
}
