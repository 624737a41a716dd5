// SPDX-License-Identifier: Apache-2.0
// Adds the lights of each tile's list to the scene radiance: all but spheres at the horizon, whose
// dearer evaluation shade_horizon does, for the tiles that this kernel finds to hold some.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/shade_receiver.glsl"
#include "lib/tile_walk.glsl"
#include "lib/light_walk.glsl"

layout(local_size_x = TILE_SIZE, local_size_y = TILE_SIZE) in;
layout(binding = SHADE_RADIANCE, rgba32f) uniform image2D radianceImage;
layout(scalar, binding = SHADE_HORIZON) buffer Horizon
{
    HorizonTiles horizon;
    uint horizonTiles[];
};

// Once per tile, by whichever lane comes first: the order of the tiles changes nothing.
void appendHorizonTile(uint tile)
{
    if (atomicOr(lists[tile].horizon, 1u) != 0u)
        return;
    const uint at = atomicAdd(horizon.count, 1u);
    horizonTiles[at] = tile;
    if (at % HORIZON_ROW == 0u)
        atomicAdd(horizon.groupsY, 1u);
}

void main()
{
    const uvec2 pixel = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(pixel, params.size)))
        return;
    const uint tile = gl_WorkGroupID.y * params.tileCountX + gl_WorkGroupID.x;
    setTileList(tile);
    const float depth = texelFetch(depthImage, ivec2(pixel), 0).x;
    if (tileList.count == 0u || depth == params.clearDepth)
        return;
    const Receiver r = makeReceiver(readShadingPoint(pixel, depth), params.errorBudget,
                                    params.sampleCount, pixelSeed(pixel));
    vec3 asPoint = vec3(0.0), above = vec3(0.0), general = vec3(0.0);
    uint atHorizon = 0u;
    for (uint first = 0u; first < tileList.count; first += WALK_BLOCK) {
        const Found found = findLights(r, first, min(WALK_BLOCK, tileList.count - first), true);
#if HAS_SPHERES
        if (HAS_BUDGET)
            SHADE_FOUND(asPoint, r, first, found.asPoint, evaluateAsPoint);
        SHADE_FOUND(above, r, first, found.above, evaluateAbove);
        atHorizon |= found.near | found.general;
#else
        SHADE_FOUND(general, r, first, found.general, evaluateGeneral);
#endif
    }
    if (atHorizon != 0u)
        appendHorizonTile(tile);
    const vec4 before = imageLoad(radianceImage, ivec2(pixel));
    imageStore(radianceImage, ivec2(pixel), before + vec4(asPoint + above + general, 0.0));
}
