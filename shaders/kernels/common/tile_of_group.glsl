// SPDX-License-Identifier: Apache-2.0
// Finds the tile that a workgroup shades, on the work list of its height and class, and the clusters
// of its pixels.
#ifndef CND_COMMON_TILE_OF_GROUP
#define CND_COMMON_TILE_OF_GROUP

#include "kernels/common/frame_params.glsl"
#include "shading/software_drivers.glsl"
#include "shared/cluster_data.h"
#include "shared/lighting_data.h"
#include "lib/tile_pixels.glsl"

layout(constant_id = SPEC_TILE_CLASS) const uint tileClass = CLASS_ANY;
layout(scalar, binding = SHADE_TILES) readonly buffer Tiles
{
    TileClusters tiles[];
};
layout(scalar, binding = SHADE_LISTS) readonly buffer Lists
{
    uint lists[];
};
layout(scalar, binding = SHADE_WORK) readonly buffer Work
{
    WorkList works[TILE_WORK_LISTS];
    uint workTiles[];
};

#include "kernels/common/cluster_of_depth.glsl"

// Sets `place` to the place in workTiles of what this workgroup shades. Returns false if there is no
// work for it.
bool takeWork(out uint place)
{
    const WorkList work = works[tileHeight * TILE_CLASSES + tileClass];
    const uint at = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    place = 0u;
    if (at >= work.count)
        return false;
    // Split tiles, which take longest, are at the end of the list. Tiles are taken from there, so that
    // the groups that run last have little to do: every second tile first, then the others, because
    // some devices divide the groups into equal consecutive shares.
    const uint firsts = (work.count + 1u) / 2u;
    const uint fromEnd = at < firsts ? 2u * at : 2u * (at - firsts) + 1u;
    place = work.first + work.count - 1u - fromEnd;
    return true;
}

// Returns the pixel of this lane, which may be outside the image.
uvec2 pixelOfTile(uint tile)
{
    return firstPixelOfTile(tile, frameParams.size.x) + pixelOfLane(gl_LocalInvocationIndex);
}

// Sets the tile of this workgroup and the pixel of this lane. Returns false after the last tile and
// outside the image.
bool takeTile(out uint tile, out uvec2 pixel)
{
    uint place;
    tile = 0u;
    pixel = uvec2(0u);
    if (!takeWork(place))
        return false;
    tile = workTiles[place];
    pixel = pixelOfTile(tile);
    return all(lessThan(pixel, frameParams.size));
}

#endif
