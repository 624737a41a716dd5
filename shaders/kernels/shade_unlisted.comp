// SPDX-License-Identifier: Apache-2.0
// Lights the pixels whose cluster has no list, by walking the light tree: with the same lights in the
// same order, but more slowly. It is another pipeline than shade_tiles, so the last bits may differ
// (DECISIONS 42). Each pixel walks the nodes whose box holds it. On devices that limit loops, clusters
// with too many lights are lit in batches, which are parts of the tree.
#version 460
#extension GL_GOOGLE_include_directive : require
#define COUNTS_DIFFER true // lightAt reads shared memory
#include "kernels/common/shade_receiver.glsl"

layout(push_constant, scalar) uniform Push
{
    ShadeUnlistedParams params;
};

#include "kernels/common/tile_of_group.glsl"
#include "kernels/common/light_tree.glsl"

// The leaves that a pixel has found, in place of a page of a list. They are in shared memory because
// an array in private memory would occupy registers, or be spilled, while lights are evaluated.
#ifdef SHADOWS
#include "shading/occluder_buffers.glsl"
#define FINDS_SHARES
#define SHARES_LANES (TILE_SIZE * TILE_SIZE)
const uint FOUND_LEAVES = SHADOW_BLOCK / TREE_WIDTH; // a block of block_visibility.glsl
#else
const uint FOUND_LEAVES = 8u; // their lights fill a block of light_walk.glsl
#endif
shared uint leaves[FOUND_LEAVES][TILE_SIZE * TILE_SIZE];

uint lightAt(uint k)
{
    const uint leaf = leaves[k / TREE_WIDTH][gl_LocalInvocationIndex];
    return params.tree.firstLight + leaf * TREE_WIDTH + k % TREE_WIDTH;
}

#define KEPT_LANES (TILE_SIZE * TILE_SIZE)
#define LANES_OF_RECEIVER 1u
#include "shading/light_walk.glsl"

layout(local_size_x = TILE_SIZE, local_size_y = TILE_SIZE) in;
#include "kernels/common/add_radiance.glsl"
#ifdef SHADOWS
#include "kernels/common/depth_error.glsl"
layout(scalar, binding = SHADE_COUNTERS) buffer Counters
{
    ShadowCounters shadowCounters;
};
#endif

void main()
{
    uint tile;
    uvec2 pixel;
    if (!takeTile(tile, pixel))
        return;
    const float depth = texelFetch(depthImage, depthTexelOf(pixel), 0).x;
    if (depth == frameParams.clearDepth)
        return;
    if (lists[clusterOf(tile, depth)] != params.listHead)
        return;
    const Receiver r =
        makeReceiver(readShadingPoint(pixel, depth), frameParams.sampleCount, pixelSeed(pixel));
    const uint packedPixel = pixel.y << 16 | pixel.x; // in one register instead of two
    keep(r);
#ifdef SHADOWS
    pointDepthError = depthErrorAt(pixel, depth, r.p.position);
#endif
    Sums sums = noLight();
    leaves[0][gl_LocalInvocationIndex] = 0u; // may be read even if no leaf is found
    TreeWalk walk = beginTreeWalk(params.tree, params.topLevel);
    const uint bits = walk.top * TREE_WIDTH_BITS;
    const uint firstAfter = params.batch.first + params.batch.count - params.tree.firstLight;
    walk.index = (params.batch.first - params.tree.firstLight) >> bits;
    const uint endOfTop = (firstAfter + (1u << bits) - 1u) >> bits;
    while (!walk.done) {
        uint found = 0u, count = 0u;
        while (!walk.done && found < FOUND_LEAVES) {
            // For the reason of IF_COUNTS_DIFFER the condition of the loop is asked for again.
            const bool walks = !walk.done && found < FOUND_LEAVES;
            const bool inside = walks && boxHolds(treeNode(walk), readAgain(r).p.position);
            if (inside && walk.level == 1u) {
                leaves[found][gl_LocalInvocationIndex] = walk.index;
                ++found;
                count += min(TREE_WIDTH, params.tree.lightCount - walk.index * TREE_WIDTH);
            }
            if (inside && walk.level > 1u)
                descend(params.tree, walk);
            else
                skipSubtree(params.tree, walk);
            walk.done = walk.done || (walk.level == walk.top && walk.index >= endOfTop);
        }
        shadeBlock(sums, r, 0u, count, true);
    }
#ifdef SHADOWS
    if (unfinishedPairs != 0u)
        atomicAdd(shadowCounters.unfinished, unfinishedPairs);
#endif
    addRadiance(uvec2(packedPixel & 0xFFFFu, packedPixel >> 16), total(sums));
}
