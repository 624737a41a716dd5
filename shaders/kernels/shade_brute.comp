// SPDX-License-Identifier: Apache-2.0
// Every light at every pixel of a rectangle: no list, no bound. What the clustered path is checked
// against, and the baseline it is timed against.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/shade_receiver.glsl"

// The k-th light of the batch.
uint lightAt(uint k)
{
    return params.firstLight + k;
}

#include "lib/light_walk.glsl"

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
    const Receiver r = makeReceiver(readShadingPoint(pixel, depth), params.errorBudget,
                                    params.sampleCount, pixelSeed(pixel));
    vec3 asPoint = vec3(0.0), above = vec3(0.0), near = vec3(0.0), general = vec3(0.0);
    for (uint first = 0u; first < params.lightCount; first += WALK_BLOCK) {
        const Found found = findLights(r, first, min(WALK_BLOCK, params.lightCount - first), false);
#if HAS_SPHERES
        if (HAS_BUDGET) {
            SHADE_FOUND(asPoint, r, first, found.asPoint, evaluateAsPoint)
        }
        SHADE_FOUND(above, r, first, found.above, evaluateAbove)
        if (IS_CONIC) {
            SHADE_FOUND(near, r, first, found.near, evaluateNear)
        }
#endif
        SHADE_FOUND(general, r, first, found.general, evaluateGeneral)
    }
    // In the order of the clustered kernels, for the same bits: shade_tiles, then shade_horizon.
    const vec4 before = imageLoad(radianceImage, ivec2(pixel));
    const vec3 tiles = before.xyz + (asPoint + above + (IS_SPHERE ? vec3(0.0) : general));
    const vec3 horizon = IS_SPHERE ? near + general : vec3(0.0);
    imageStore(radianceImage, ivec2(pixel), vec4(tiles + horizon, before.w));
}
