// SPDX-License-Identifier: Apache-2.0
// shade_brute.comp for lights of one type that are evaluated by linearly transformed cosines.
#version 460
#extension GL_GOOGLE_include_directive : require
#define LIGHT_FAMILY_POLYGON
#include "lib/tile_pixels.glsl"
#include "kernels/common/shade_receiver.glsl"
#include "shared/bench.h"

layout(push_constant, scalar) uniform Push
{
    LightBatch batch;
};

uint lightAt(uint k)
{
    return batch.first + k;
}

#include "bench/ltc/lights.glsl"

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
    const LtcReceiver r = makeLtcReceiver(makeReceiver(readShadingPoint(pixel, depth), 1u, 0u));
    vec3 sum = vec3(0.0);
    for (uint k = 0u; k < batch.count; ++k)
        sum += evaluateClassified(r, lightAt(k));
    const vec4 before = imageLoad(radianceImage, ivec2(pixel));
    imageStore(radianceImage, ivec2(pixel), before + vec4(sum, 0.0));
}
