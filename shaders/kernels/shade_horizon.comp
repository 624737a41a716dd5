// SPDX-License-Identifier: Apache-2.0
// Adds the spheres that cross or nearly touch the horizon of a pixel, in the tiles that shade_tiles
// found to hold some. A kernel of its own: elsewhere its registers and masked branches would be paid
// for nothing.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/shade_receiver.glsl"
#include "lib/tile_walk.glsl"
#include "lib/light_walk.glsl"

layout(local_size_x = TILE_SIZE, local_size_y = TILE_SIZE) in;
layout(binding = SHADE_RADIANCE, rgba32f) uniform image2D radianceImage;
layout(scalar, binding = SHADE_HORIZON) readonly buffer Horizon
{
    HorizonTiles horizon;
    uint horizonTiles[];
};

void main()
{
    const uint at = gl_WorkGroupID.y * HORIZON_ROW + gl_WorkGroupID.x;
    if (at >= horizon.count)
        return;
    const uint tile = horizonTiles[at];
    const uvec2 tileXY = uvec2(tile % params.tileCountX, tile / params.tileCountX);
    const uvec2 pixel = tileXY * TILE_SIZE + gl_LocalInvocationID.xy;
    if (any(greaterThanEqual(pixel, params.size)))
        return;
    setTileList(tile);
    const float depth = texelFetch(depthImage, ivec2(pixel), 0).x;
    if (depth == params.clearDepth)
        return;
    const Receiver r = makeReceiver(readShadingPoint(pixel, depth), params.errorBudget,
                                    params.sampleCount, pixelSeed(pixel));
    vec3 near = vec3(0.0), general = vec3(0.0);
    for (uint first = 0u; first < tileList.count; first += WALK_BLOCK) {
        const Found found = findLights(r, first, min(WALK_BLOCK, tileList.count - first), true);
        if (IS_CONIC) {
            SHADE_FOUND(near, r, first, found.near, evaluateNear)
        }
        SHADE_FOUND(general, r, first, found.general, evaluateGeneral)
    }
    const vec4 before = imageLoad(radianceImage, ivec2(pixel));
    imageStore(radianceImage, ivec2(pixel), before + vec4(near + general, 0.0));
}
