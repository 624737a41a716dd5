// SPDX-License-Identifier: Apache-2.0
// Evaluates every light at every pixel of a rectangle, without lists or bounds. The images and times of
// the clustered path are compared with those of this kernel.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/tile_pixels.glsl"
#include "kernels/common/shade_receiver.glsl"

layout(push_constant, scalar) uniform Push
{
    ShadeBruteParams params;
};

// Returns the k-th light of the batch.
uint lightAt(uint k)
{
    return params.batch.first + k;
}

#ifdef SHADOWS
#include "shading/shadow_view.glsl"
layout(scalar, binding = SHADOW_SLOTS) readonly buffer Slots
{
    uint slots[];
};

// Returns the visible shares of the k-th light of the batch at this lane's pixel.
uint visibleSharesAt(uint k)
{
    if (shadowView.asks == 0u)
        return SHARES_LIT;
    const uint tile = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    return slots[(tile * params.batch.count + k) * SLOT_WORDS + gl_LocalInvocationIndex];
}
#endif

#define KEPT_LANES (TILE_SIZE * TILE_SIZE)
#define LANES_OF_RECEIVER 1u
#include "shading/light_walk.glsl"

layout(local_size_x = TILE_SIZE, local_size_y = TILE_SIZE) in;
#include "kernels/common/add_radiance.glsl"

void main()
{
    const uvec2 pixel =
        params.first + TILE_SIZE * gl_WorkGroupID.xy + pixelOfLane(gl_LocalInvocationIndex);
    if (any(greaterThanEqual(pixel, params.end)))
        return;
    const float depth = texelFetch(depthImage, depthTexelOf(pixel), 0).x;
    if (depth == frameParams.clearDepth)
        return;
    const Receiver r =
        makeReceiver(readShadingPoint(pixel, depth), frameParams.sampleCount, pixelSeed(pixel));
    keep(r);
    Sums sums = noLight();
    for (uint first = 0u; first < params.batch.count; first += WALK_BLOCK)
        shadeBlock(sums, r, first, min(WALK_BLOCK, params.batch.count - first), false);
    addRadiance(pixel, total(sums));
}
