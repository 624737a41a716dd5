// SPDX-License-Identifier: Apache-2.0
// Bounds of surface samples: a box, a slab along an axis near their normals, a cone of normals and a
// cone of view rays. They are made from the exact positions instead of a slice of the frustum, so that
// lights are culled against the surfaces that are there.
#include "shared/clusters.h"
#include "lib/cluster_margins.glsl"
#define GBUFFER_CODE SPEC_GBUFFER
#define GBUFFER_IMAGES TILE_CLUSTERS_GBUFFER
#define FRAME_PARAMS TILE_CLUSTERS_FRAME
#include "kernels/common/read_gbuffer.glsl"
#include "lib/projection.glsl"
#include "lib/tile_pixels.glsl"

layout(push_constant, scalar) uniform Push
{
    TileClustersParams params;
};
layout(binding = TILE_CLUSTERS_DEPTH) uniform texture2D depthImage;
layout(scalar, binding = TILE_CLUSTERS_CLUSTERS) writeonly buffer Clusters
{
    Cluster clusters[];
};
float depthAt(uvec2 pixel)
{
    return texelFetch(depthImage, ivec2(pixel), 0).x;
}

Cluster emptyCluster(uint tile)
{
    const uvec2 middle = firstPixelOfTile(tile, frameParams.size.x) + TILE_SIZE / 2u;
    const vec3 ray = viewRay(frameParams.projection, middle, frameParams.invImageSize);
    return Cluster(vec3(UNBOUNDED), tile, vec3(-UNBOUNDED), 0u, vec3(0.0), UNBOUNDED, -UNBOUNDED, 1.0,
                   0xFFFFFFFFu, normalize(ray), 0.0);
}

bool isEmpty(Cluster c)
{
    return c.min.x > c.max.x;
}

// Adds a sample to a cluster, whose axis is the normal of the first sample.
void addSample(inout Cluster c, uvec2 pixel, float depth)
{
    const vec3 p = viewPosition(frameParams.projection, pixel, frameParams.invImageSize, depth);
    const vec3 n = readNormal(ivec2(pixel));
    c.axis = isEmpty(c) ? n : c.axis;
    c.depthBits = min(c.depthBits, depthBits(depth));
    c.min = min(c.min, p);
    c.max = max(c.max, p);
    const float along = dot(c.axis, p);
    c.slabMin = min(c.slabMin, along);
    c.slabMax = max(c.slabMax, along);
    c.minCos = min(c.minCos, dot(c.axis, n));
    const float ahead = dot(p, c.ray);
    const float aside = length(cross(p, c.ray));
    c.slope = max(c.slope, aside < MAX_SLOPE * ahead ? aside / ahead : MAX_SLOPE);
}
