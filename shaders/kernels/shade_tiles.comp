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

#include "kernels/common/part_of_list.glsl"
#ifdef SHADOWS
#include "kernels/common/visible_shares_at.glsl"
#endif
#define MAY_READ_AHEAD true
#define KEPT_LANES (TILE_SIZE * TILE_SIZE)
#define LANES_OF_RECEIVER 1u
#include "shading/light_walk.glsl"

#include "kernels/common/add_radiance.glsl"

Receiver receiverAt(uvec2 pixel, float depth)
{
    return makeReceiver(readShadingPoint(pixel, depth), frameParams.sampleCount, pixelSeed(pixel));
}

// Each lane evaluates all lights of its pixel, or those of a part of its list.
void shade(TileWork work, uvec2 pixel, float depth)
{
    Block block = beginWalk(params.batch, work.tile, depth);
    if (work.list != 0u) {
        if (block.first != work.list * PAGE_WORDS + 1u) // the pixel has another list
            return;
        block = partBlock(params.batch, work);
    } else if (block.count == 0u)
        return;
    const Receiver r = receiverAt(pixel, depth);
    const uint packedPixel = pixel.y << 16 | pixel.x; // in one register instead of two
    keep(r);
    Sums sums = noLight();
    uint pages = 0u; // that have been walked
    do {
        shadeBlock(sums, r, block.first, block.count, true);
        ++pages;
        if (work.list != 0u && pages == PART_PAGES)
            block.next = 0u;
        block = nextBlock(params.batch, block);
    } while (block.count != 0u);
    vec3 light = total(sums);
    if (work.list != 0u && !sumOfParts(work, light))
        return;
    addRadiance(uvec2(packedPixel & 0xFFFFu, packedPixel >> 16), light);
}

void main()
{
    uint place;
    if (!takeWork(place))
        return;
    const TileWork work = tileWork(place);
    const uvec2 pixel = pixelOfTile(work.tile);
    if (any(greaterThanEqual(pixel, frameParams.size)))
        return;
#ifdef SHADOWS
    walkedTile = work.tile;
#endif
    const float depth = texelFetch(depthImage, depthTexelOf(pixel), 0).x;
    if (depth != frameParams.clearDepth)
        shade(work, pixel, depth);
}
