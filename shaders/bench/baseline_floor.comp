// SPDX-License-Identifier: Apache-2.0
// Measures the cost of shading without any search for lights. Every pixel evaluates as many lights in
// each way as contribute to it, but takes them from a tiny fixed list, so the image is meaningless.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/tile_pixels.glsl"
#include "kernels/common/shade_receiver.glsl"
#include "shared/baselines.h"

uint lightAt(uint k)
{
    return k % FLOOR_LIGHTS;
}

#include "shading/light_walk.glsl"

layout(local_size_x = TILE_SIZE, local_size_y = TILE_SIZE) in;
layout(binding = RADIANCE_IMAGE, rgba32f) uniform image2D radianceImage;
layout(scalar, binding = BASELINE_FOUND) readonly buffer FoundPerPixel
{
    uint foundPerPixel[];
};

#define EVALUATE(sum, count, evaluate)                                                             \
    if (count != 0u) {                                                                             \
        uint k = 0u;                                                                               \
        do {                                                                                       \
            sum += evaluate(r, lightAt(k));                                                        \
            ++k;                                                                                   \
        } while (k < count);                                                                       \
    }

void main()
{
    const uvec2 pixel = TILE_SIZE * gl_WorkGroupID.xy + pixelOfLane(gl_LocalInvocationIndex);
    if (any(greaterThanEqual(pixel, frameParams.size)))
        return;
    const float depth = texelFetch(depthImage, ivec2(pixel), 0).x;
    if (depth == frameParams.clearDepth)
        return;
    const uint found = foundPerPixel[pixel.y * frameParams.size.x + pixel.x];
    const uint above = found & 255u, near = found >> 8 & 255u, general = found >> 16;
    if (found == 0u)
        return;
    const Receiver r =
        makeReceiver(readShadingPoint(pixel, depth), frameParams.sampleCount, pixelSeed(pixel));
    Sums sums = noLight();
    EVALUATE(sums.near, near, evaluate_NEAR)
    EVALUATE(sums.above, above, evaluate_ABOVE)
    EVALUATE(sums.general, general, evaluate_GENERAL)
    const vec4 before = imageLoad(radianceImage, ivec2(pixel));
    imageStore(radianceImage, ivec2(pixel), before + vec4(total(sums), 0.0));
}
