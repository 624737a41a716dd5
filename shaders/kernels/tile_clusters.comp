// SPDX-License-Identifier: Apache-2.0
// Makes clusters of surface samples: one per 8x8 pixel tile. A deep tile has one cluster per slice of
// its depth instead, which split_tiles makes. Several lanes make the cluster of a tile, each from a row
// of its pixels.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernels/common/tile_record.glsl"

layout(local_size_x = TILE_CLUSTERS_GROUP) in;
#include "kernels/common/bounds_of_rows.glsl"

shared uint diffuseTiles[CLUSTERS_OF_GROUP]; // 1: no surface has a specular lobe

// Finds the classes of the tiles. All lanes of the group must call it.
void findClassesByRows(FrameParams frame, SamplesOfTile samples)
{
    diffuseTiles[clusterOfLane()] = 1u;
    barrier();
    bool diffuse = true;
    for (uint x = 0u; x < TILE_SIZE && diffuse; ++x) {
        uvec2 pixel;
        float depth;
        if (takeSample(frame, samples, x, pixel, depth))
            diffuse = isDiffuse(pixel);
    }
    atomicAnd(diffuseTiles[clusterOfLane()], diffuse ? 1u : 0u);
    barrier();
}

// The lanes of a group make the clusters of several tiles. Every lane takes part in the barriers.
void main()
{
    const uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    const FrameParams frame = frameParams;
    const uint tileOfRow = group * CLUSTERS_OF_GROUP + clusterOfLane();
    const SamplesOfTile samples = SamplesOfTile(firstPixelOfTile(tileOfRow, frame.size.x),
                                                tileOfRow < params.tileCount, 0u, UNSPLIT, 0u);
    findBoundsByRows(frame, tileOfRow, samples);
    if (findsDiffuse)
        findClassesByRows(frame, samples);
    const uint lane = gl_LocalInvocationIndex, tile = group * CLUSTERS_OF_GROUP + lane;
    if (lane >= CLUSTERS_OF_GROUP || tile >= params.tileCount)
        return;
    uint highest;
    const Cluster cluster = boundsFound(frame, tile, lane, highest);
    writeTile(frame, tile, cluster, highest, classOf(findsDiffuse && diffuseTiles[lane] != 0u));
}
