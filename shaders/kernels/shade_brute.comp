// SPDX-License-Identifier: Apache-2.0
// Every light at every pixel of a rectangle: no list, no bound. What the clustered path is checked
// against, and the baseline it is timed against.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/pixel_of_lane.glsl"
#include "kernels/common/shade_receiver.glsl"

// The k-th light of the batch.
uint lightAt(uint k)
{
    return params.firstLight + k;
}

#include "shading/light_walk.glsl"

layout(local_size_x = TILE_SIZE, local_size_y = TILE_SIZE) in;
layout(binding = SHADE_RADIANCE, rgba32f) uniform image2D radianceImage;

void main()
{
    const uvec2 pixel =
        params.origin + TILE_SIZE * gl_WorkGroupID.xy + pixelOfLane(gl_LocalInvocationIndex);
    if (any(greaterThanEqual(pixel, params.size)))
        return;
    const float depth = texelFetch(depthImage, ivec2(pixel), 0).x;
    if (depth == params.clearDepth)
        return;
    const Receiver r = makeReceiver(readShadingPoint(pixel, depth), params.errorBudget,
                                    params.sampleCount, pixelSeed(pixel));
    Sums sums = noLight();
    for (uint first = 0u; first < params.lightCount; first += WALK_BLOCK)
        shadeBlock(sums, r, first, min(WALK_BLOCK, params.lightCount - first), false);
    const vec4 before = imageLoad(radianceImage, ivec2(pixel));
    imageStore(radianceImage, ivec2(pixel), before + vec4(total(sums), 0.0));
}
