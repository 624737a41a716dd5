// SPDX-License-Identifier: Apache-2.0
// count_pairs.comp for the lists of a baseline. It also counts how many lights each pixel evaluates in
// each way.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_vote : require
#include "lib/tile_pixels.glsl"
#include "kernels/common/shade_receiver.glsl"
#include "bench/baseline_walk.glsl"
#include "shading/light_walk.glsl"

layout(local_size_x = TILE_SIZE, local_size_y = TILE_SIZE) in;
layout(scalar, binding = BASELINE_COUNTERS) buffer Counters
{
    BaselineCounters counters;
};
layout(scalar, binding = BASELINE_FOUND) writeonly buffer FoundPerPixel
{
    uint foundPerPixel[];
};

uint bits(uvec2 x)
{
    return uint(bitCount(x.x) + bitCount(x.y));
}

// Returns how many turns the loop over `found` takes for this lane, including turns in which it waits
// for others.
uint turns(uvec2 found)
{
    return subgroupMax(bits(found));
}

// 64-bit sum: the addition that wraps around carries.
#define COUNT(counter, n)                                                                          \
    {                                                                                              \
        const uint more = subgroupAdd(n);                                                          \
        if (subgroupElect() && atomicAdd(counter.x, more) + more < more)                           \
            atomicAdd(counter.y, 1u);                                                              \
    }

void main()
{
    const uvec2 pixel = TILE_SIZE * gl_WorkGroupID.xy + pixelOfLane(gl_LocalInvocationIndex);
    const bool inside = all(lessThan(pixel, frameParams.size));
    const float depth = inside ? texelFetch(depthImage, ivec2(pixel), 0).x : frameParams.clearDepth;
    const bool surface = depth != frameParams.clearDepth;
    uint listed = 0u, evaluated = 0u, influenced = 0u;
    uvec3 found3 = uvec3(0u); // lights evaluated above, near and across the horizon (general)
    Block block = Block(0u, 0u, 0u);
    Receiver r;
    if (surface) {
        const ShadingPoint p = readShadingPoint(pixel, depth);
        block = beginWalk(pixel, -p.position.z);
        r = makeReceiver(p, 1u, 0u);
    }
    while (subgroupAny(block.count != 0u)) {
        Found found = Found(uvec2(0u), uvec2(0u), uvec2(0u));
        if (block.count != 0u)
            found = findLights(r, block.first, block.count, true);
        listed += block.count;
        evaluated += turns(found.above) + turns(found.near) + turns(found.general);
        found3 += uvec3(bits(found.above), bits(found.near), bits(found.general));
        for (uint k = 0u; k < block.count; ++k) {
            const uint light = lightAt(block.first + k);
            const vec3 toLight = towardsLight(lightCentre(light).xyz, r.p.position);
            influenced += length2(toLight) < lightEmission(light).w ? 1u : 0u;
        }
        block = nextBlock(block);
    }
    const uvec3 kept = min(found3, uvec3(255u));
    if (inside)
        foundPerPixel[pixel.y * frameParams.size.x + pixel.x] = kept.x | kept.y << 8 | kept.z << 16;
    COUNT(counters.listedPairs, listed)
    COUNT(counters.evaluatedPairs, evaluated)
    COUNT(counters.insidePairs, influenced)
    COUNT(counters.contributingPairs, found3.x + found3.y + found3.z)
}
