// SPDX-License-Identifier: Apache-2.0
// Counts what shade_tiles does: entries walked, of those inside influence, of those evaluated.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/shade_inputs.glsl"
#include "lib/tile_walk.glsl"
#include "lib/light_reach.glsl"

layout(local_size_x = TILE_SIZE, local_size_y = TILE_SIZE) in;
layout(scalar, binding = SHADE_COUNTERS) buffer Counters
{
    LightingCounters counters;
};

shared uvec3 groupPairs[TILE_SIZE * TILE_SIZE];

void main()
{
    const uvec2 pixel = gl_GlobalInvocationID.xy;
    const ivec2 readable = ivec2(min(pixel, params.size - 1u));
    setTileList(gl_WorkGroupID.y * params.tileCountX + gl_WorkGroupID.x);
    const float depth = texelFetch(depthImage, readable, 0).x;
    uvec3 pairs = uvec3(0u);
    if (all(lessThan(pixel, params.size)) && depth != params.clearDepth) {
        const vec3 position = viewPosition(params.projection, pixel, params.invImageSize, depth);
        const vec3 n = readSurface(readable).normal;
        pairs.x = tileList.count;
        for (uint k = 0u; k < tileList.count; ++k) {
            const uint light = lightAt(k);
            const vec4 centreReach = lightCentre(light);
            const float influence2 = lightEmission(light).w;
            const vec3 toLight = towardsLight(centreReach.xyz, position);
            pairs.y += length2(toLight) < influence2 ? 1u : 0u;
            pairs.z += lightReaches(toLight, n, centreReach.w, influence2) ? 1u : 0u;
        }
    }
    groupPairs[gl_LocalInvocationIndex] = pairs;
    barrier();
    if (gl_LocalInvocationIndex != 0u)
        return;
    uvec3 total = uvec3(0u); // at most 64 x lights: fits 32 bits up to 67 million lights
    for (uint i = 0u; i < TILE_SIZE * TILE_SIZE; ++i)
        total += groupPairs[i];
    // 64-bit sums: the addition that wraps carries.
    if (atomicAdd(counters.listedPairs.x, total.x) + total.x < total.x)
        atomicAdd(counters.listedPairs.y, 1u);
    if (atomicAdd(counters.insidePairs.x, total.y) + total.y < total.y)
        atomicAdd(counters.insidePairs.y, 1u);
    if (atomicAdd(counters.evaluatedPairs.x, total.z) + total.z < total.z)
        atomicAdd(counters.evaluatedPairs.y, 1u);
}
