// SPDX-License-Identifier: Apache-2.0
// Every light at every pixel of a rectangle: no list, no bound, no early-out. What the clustered
// path is checked against, and the baseline it is timed against.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/shade_inputs.glsl"
#include "lib/light_eval.glsl"

layout(local_size_x = TILE_SIZE, local_size_y = TILE_SIZE) in;
layout(binding = SHADE_RADIANCE, rgba32f) uniform image2D radianceImage;

void main()
{
    const uvec2 pixel = gl_GlobalInvocationID.xy + params.origin;
    if (any(greaterThanEqual(pixel, params.size)))
        return;
    const float depth = texelFetch(depthImage, ivec2(pixel), 0).x;
    if (depth == params.clearDepth)
        return;
    const vec3 position = viewPosition(params.projection, pixel, params.invImageSize, depth);
    const ShadingPoint p = makeShadingPoint(readSurface(ivec2(pixel)), position,
                                            towardsEye(params.projection, position));
    vec3 sum = vec3(0.0);
    for (uint light = params.firstLight; light < params.firstLight + params.lightCount; ++light)
        sum += evaluateLight(p, light, lightCentre(light), lightEmission(light));
    const vec4 before = imageLoad(radianceImage, ivec2(pixel));
    imageStore(radianceImage, ivec2(pixel), before + vec4(sum, 0.0));
}
