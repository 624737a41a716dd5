// SPDX-License-Identifier: Apache-2.0
// Adds the lights of each tile's list to the scene radiance.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/shade_receiver.glsl"
#include "lib/tile_walk.glsl"
#include "lib/light_walk.glsl"

layout(local_size_x = TILE_SIZE, local_size_y = TILE_SIZE) in;
layout(binding = SHADE_RADIANCE, rgba32f) uniform image2D radianceImage;

void main()
{
    const uvec2 pixel = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(pixel, params.size)))
        return;
    setTileList(gl_WorkGroupID.y * params.tileCountX + gl_WorkGroupID.x);
    const float depth = texelFetch(depthImage, ivec2(pixel), 0).x;
    if (tileList.count == 0u || depth == params.clearDepth)
        return;
    const Receiver r = makeReceiver(readShadingPoint(pixel, depth), params.errorBudget,
                                    params.sampleCount, pixelSeed(pixel));
    Sums sums = noLight();
    for (uint first = 0u; first < tileList.count; first += WALK_BLOCK)
        shadeBlock(sums, r, first, min(WALK_BLOCK, tileList.count - first), true);
    const vec4 before = imageLoad(radianceImage, ivec2(pixel));
    imageStore(radianceImage, ivec2(pixel), before + vec4(total(sums), 0.0));
}
