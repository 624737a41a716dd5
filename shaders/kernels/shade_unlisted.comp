// SPDX-License-Identifier: Apache-2.0
// Lights the pixels whose cluster has no list, by walking the light tree: with the same lights in the
// same order, so with the same bits, but more slowly. On devices that limit loops, clusters with too
// many lights are lit in batches, which are parts of the tree.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernels/common/shade_receiver.glsl"

layout(push_constant, scalar) uniform Push
{
    ShadeUnlistedParams params;
};

#include "lib/cluster_test.glsl"
#include "kernels/common/tile_of_group.glsl"
#define TREE_NODES SHADE_NODES
#define TREE_NODE_WORDS SHADE_NODE_WORDS
#include "kernels/common/light_tree.glsl"

// The lights that a walk has found, in place of a page of a list.
uint page[PAGE_LIGHTS];

uint lightAt(uint k)
{
    return page[k];
}

#include "shading/light_walk.glsl"

layout(local_size_x = TILE_SIZE, local_size_y = TILE_SIZE) in;
layout(binding = SHADE_RADIANCE, rgba32f) uniform image2D radianceImage;
layout(scalar, binding = SHADE_CLUSTERS) readonly buffer Clusters
{
    Cluster clusters[];
};

void main()
{
    uint tile;
    uvec2 pixel;
    if (!takeTile(tile, pixel))
        return;
    const float depth = texelFetch(depthImage, ivec2(pixel), 0).x;
    if (depth == frameParams.clearDepth)
        return;
    const uint cluster = clusterOf(tile, depth);
    const uint list = lists[cluster];
    if (list != params.listHead)
        return;
    const Receiver r = makeReceiver(readShadingPoint(pixel, depth), frameParams.errorBudget,
                                    frameParams.sampleCount, pixelSeed(pixel));
    Sums sums = noLight();
    page[0] = params.tree.firstLight; // may be read even if no light is found
    const uint end = params.tree.firstLight + params.tree.lightCount;
    const ClusterBounds bounds = makeClusterBounds(clusters[cluster]);
    TreeWalk walk = beginTreeWalk(params.tree, params.topLevel);
    const uint bits = walk.top * TREE_WIDTH_BITS;
    const uint firstAfter = params.batch.first + params.batch.count - params.tree.firstLight;
    walk.index = (params.batch.first - params.tree.firstLight) >> bits;
    const uint endOfTop = (firstAfter + (1u << bits) - 1u) >> bits;
    while (!walk.done) {
        uint inPage = 0u;
        while (!walk.done && inPage + TREE_WIDTH <= PAGE_LIGHTS) {
            const bool touched = boxTouches(bounds, treeNode(walk));
            const uint first = params.tree.firstLight + walk.index * TREE_WIDTH;
            const uint count = touched && walk.level == 1u ? min(TREE_WIDTH, end - first) : 0u;
            for (uint i = 0u; i < count; ++i) {
                const vec4 centre = lightCentre(first + i);
                if (lightTouches(bounds, centre.xyz, centre.w, lightEmission(first + i).w)) {
                    page[inPage] = first + i;
                    ++inPage;
                }
            }
            if (touched && walk.level > 1u)
                descend(params.tree, walk);
            else
                skipSubtree(params.tree, walk);
            walk.done = walk.done || (walk.level == walk.top && walk.index >= endOfTop);
        }
        shadeBlock(sums, r, 0u, inPage, true);
    }
    const vec4 before = imageLoad(radianceImage, ivec2(pixel));
    imageStore(radianceImage, ivec2(pixel), before + vec4(total(sums), 0.0));
}
