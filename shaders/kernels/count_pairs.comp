// SPDX-License-Identifier: Apache-2.0
// Counts the work of shade_tiles in pairs of pixel and light: entries of lists that are walked, pairs
// that are evaluated (also by lanes that are masked out), lights whose influence reaches the pixel, and
// lights that can contribute to it.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_vote : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#include "kernels/common/shade_receiver.glsl"

layout(push_constant, scalar) uniform Push
{
    CountPairsParams params;
};

#include "kernels/common/tile_walk.glsl"
#include "shading/light_walk.glsl"
#include "kernels/common/count_in_64_bits.glsl"

layout(local_size_x = TILE_SIZE, local_size_y = TILE_SIZE) in;
layout(scalar, binding = SHADE_COUNTERS) buffer Counters
{
    LightingCounters counters;
};

layout(binding = SHADE_PAIRS, rgba32f) uniform image2D pairImage;

uint classOf(uint tile, float depth)
{
    if (IS_DISTANT)
        return PIXEL_OF_TILE;
    const uint list = lists[clusterOf(tile, depth)];
    const bool slices = tiles[tile].shift != UNSPLIT;
    return list == LIST_UNLISTED || list == LIST_LONG ? PIXEL_UNLISTED
           : slices                                   ? PIXEL_OF_SLICE
                                                      : PIXEL_OF_TILE;
}

uint bits(uvec2 x)
{
    return uint(bitCount(x.x) + bitCount(x.y));
}

// Returns how often this lane runs the loop over `found`, including the turns in which it waits for
// other lanes.
uint turns(uvec2 found)
{
    return subgroupMax(bits(found));
}

void main()
{
    uint tile;
    uvec2 pixel;
    const bool inside = takeTile(tile, pixel);
    const float depth =
        inside ? texelFetch(depthImage, depthTexelOf(pixel), 0).x : frameParams.clearDepth;
    const bool surface = inside && depth != frameParams.clearDepth;
    uint listed = 0u, evaluated = 0u, influenced = 0u, contributing = 0u;
    Block block = surface ? beginWalk(params.batch, tile, depth) : Block(0u, 0u, 0u);
    if (block.count == 0u && block.next != 0u) // several groups share the list
        block = nextBlock(params.batch, block);
    Receiver r;
    if (surface)
        r = makeReceiver(readShadingPoint(pixel, depth), 1u, 0u);
    while (subgroupAny(block.count != 0u)) {
        Found found = Found(uvec2(0u), uvec2(0u), uvec2(0u));
        if (block.count != 0u)
            found = findLights(r, block.first, block.count, true);
        listed += block.count;
        evaluated += turns(found.above) + turns(found.near) + turns(found.general);
        contributing += bits(found.above | found.near | found.general);
        for (uint k = 0u; k < block.count; ++k) {
            const uint light = lightAt(block.first + k);
            const vec3 toLight = towardsLight(lightCentre(light).xyz, r.p.position);
            influenced += length2(toLight) < lightEmission(light).w ? 1u : 0u;
        }
        block = nextBlock(params.batch, block);
    }
    if (surface && params.writesImage != 0u) {
        const ivec2 texel = texelOf(pixel);
        const vec4 before = imageLoad(pairImage, texel);
        imageStore(pairImage, texel,
                   vec4(before.xyz + vec3(listed, evaluated, contributing),
                        max(before.w, float(classOf(tile, depth)))));
    }
    COUNT(counters.listedPairs, listed)
    COUNT(counters.evaluatedPairs, evaluated)
    COUNT(counters.insidePairs, influenced)
    COUNT(counters.contributingPairs, contributing)
}
