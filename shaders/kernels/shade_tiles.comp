// SPDX-License-Identifier: Apache-2.0
// Adds the light of each cluster's list to the scene radiance, in the tiles of a work list. A group of
// lanes takes a tile, and each lane a pixel.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernels/common/shade_receiver.glsl"

layout(local_size_x = TILE_SIZE, local_size_y = TILE_SIZE) in;
layout(push_constant, scalar) uniform Push
{
    ShadeTilesParams params;
};

#include "kernels/common/count_lanes.glsl"
#include "kernels/common/tile_walk.glsl"
#define KEPT_RECEIVERS (TILE_SIZE * TILE_SIZE)
#define KEPT_RECEIVER gl_LocalInvocationIndex
#define KEPT_LANES KEPT_RECEIVERS
#include "shading/light_walk.glsl"

#define RADIANCE_IMAGE SHADE_RADIANCE
#include "kernels/common/add_radiance.glsl"

Receiver receiverAt(uvec2 pixel, float depth)
{
    return makeReceiver(readShadingPoint(pixel, depth), frameParams.errorBudget,
                        frameParams.sampleCount, pixelSeed(pixel));
}

// Each lane evaluates all lights of its pixel.
void shadeAlone(uint tile, uvec2 pixel, float depth)
{
    Block block = beginWalk(tile, depth);
    if (block.count == 0u)
        return;
    const Receiver r = receiverAt(pixel, depth);
    const uint packedPixel = pixel.y << 16 | pixel.x; // in one register instead of two
    keep(r);
    Sums sums = noLight();
    do { // a lane that is done may run once more (Mesa 22.3); its block is then empty
        shadeBlock(sums, r, block.first, block.count, true);
        block = nextBlock(block);
    } while (block.count != 0u);
    addRadiance(ivec2(packedPixel & 0xFFFFu, packedPixel >> 16), total(sums));
}

// LANES_ALONE leaves out what is for GPUs only, because llvmpipe takes three times as long to compile a
// kernel that contains it, even if a constant says that it is not run.
#if defined(LIGHT_FAMILY_CONIC) && !defined(LANES_ALONE)
layout(constant_id = SPEC_LANES_TOGETHER) const bool lanesTogether = false;
const bool SHARES_PAIRS = lanesTogether;
#include "kernels/common/pair_queues.glsl"

// Returns the receiver of a pixel of the group's tile.
Receiver receiverInTile(uint tile, uint lane)
{
    const uvec2 pixel = pixelOfTile(tile, lane);
    return receiverAt(pixel, texelFetch(depthImage, ivec2(pixel), 0).x);
}

// The lanes evaluate the lights of all their pixels together. All lanes of the group call it.
void shadeTogether(uint tile, uvec2 pixel, float depth, bool surface)
{
    beginQueues();
    Block block = Block(0u, 0u, 0u);
    if (surface)
        block = beginWalk(tile, depth);
    const bool lit = block.count != 0u;
    Unqueued left = nothingToQueue();
    Sums sums = noLight();
    bool unqueued = false, unfinished; // whether some lane has pairs left to queue, or blocks to take
    uint step = 0u;
    do {
        // Lanes take their next blocks together, once all pairs of the last ones are queued.
        if (!unqueued) {
            Found found = Found(uvec2(0u), uvec2(0u), uvec2(0u), uvec2(0u));
            if (block.count != 0u) {
                found = findLights(receiverAt(pixel, depth), block.first, block.count, true);
                left = Unqueued(block.first, uvec2[QUEUES](found.near, found.general, uvec2(0u)));
            }
            if (queueingAboveIsFaster(found.above)) {
                left.inQueue[QUEUE_ABOVE] = found.above;
                found.above = uvec2(0u);
            }
            COUNT_FOUND(block.count, Found(uvec2(0u), found.above, uvec2(0u), uvec2(0u)))
            if (block.count != 0u) {
                shadeInPlace(sums, receiverAt(pixel, depth), block.first, found);
                block = nextBlock(block);
            }
        }
        const OwnPairs own = queuePairs(left);
        endOfStep(++step, !isEmpty(left), block.count != 0u);
        unqueued = lastUnqueued == step;
        unfinished = lastUnfinished == step;
        COUNT_QUEUES(turnsInQueue(QUEUE_NEAR), turnsInQueue(QUEUE_ACROSS), turnsInQueue(QUEUE_ABOVE))
        EVALUATE_QUEUE(QUEUE_NEAR, tile, evaluateNear)
        EVALUATE_QUEUE(QUEUE_ACROSS, tile, evaluateGeneral)
        EVALUATE_QUEUE(QUEUE_ABOVE, tile, evaluateAbove)
        barrier();
        emptyQueues();
        addResponses(nearLight[gl_LocalInvocationIndex], QUEUE_NEAR, own);
        addResponses(acrossLight[gl_LocalInvocationIndex], QUEUE_ACROSS, own);
        addResponses(sums.above, QUEUE_ABOVE, own);
        barrier();
    } while (unqueued || unfinished);
    sums.near = nearLight[gl_LocalInvocationIndex];
    sums.general = acrossLight[gl_LocalInvocationIndex];
    if (lit)
        addRadiance(ivec2(pixel), total(sums));
}
#else
const bool SHARES_PAIRS = false;
void shadeTogether(uint tile, uvec2 pixel, float depth, bool surface)
{
}
#endif

void main()
{
    uint tile;
    if (!takeTile(tile))
        return;
    const uvec2 pixel = pixelOfTile(tile, gl_LocalInvocationIndex);
    const float depth =
        isInImage(pixel) ? texelFetch(depthImage, ivec2(pixel), 0).x : frameParams.clearDepth;
    const bool surface = depth != frameParams.clearDepth;
    if (SHARES_PAIRS)
        shadeTogether(tile, pixel, depth, surface);
    else if (surface)
        shadeAlone(tile, pixel, depth);
}
