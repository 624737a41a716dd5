// SPDX-License-Identifier: Apache-2.0
// Bounds of surface samples: a box, a slab along an axis near their normals, a cone of normals and a
// cone of view rays. They are made from the exact positions instead of a slice of the frustum, so that
// lights are culled against the surfaces that are there.
#include "shared/clusters.h"
#include "lib/bounds.glsl"
#define GBUFFER_CODE SPEC_GBUFFER
#define GBUFFER_PACKED TILE_CLUSTERS_NORMALS
#define GBUFFER_NORMAL TILE_CLUSTERS_HOST_NORMALS
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
    const float infinity = uintBitsToFloat(0x7F800000u);
    const uvec2 middle = firstPixelOfTile(tile, frameParams.size.x) + TILE_SIZE / 2u;
    const vec3 ray = viewRay(frameParams.projection, middle, frameParams.invImageSize);
    return Cluster(vec3(infinity), tile, vec3(-infinity), 0u, vec3(0.0), infinity, -infinity, 1.0,
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
    const float slope = length(cross(p, c.ray)) / ahead;
    c.slope = max(c.slope, ahead > 0.0 ? slope : uintBitsToFloat(0x7F800000u));
}

// Error of the cosine between two normals whose lengths are 1 within 2 ulp. The error of the sine of a
// small angle is far larger, and a light just above the horizon must not be taken for one below it.
const float COS_MARGIN = 16.0 / 16777216.0;

// Returns the cluster widened by the largest effect of rounding.
Cluster withMargins(Cluster c)
{
    const float margin = DOT_MARGIN * max(largest(c.min), largest(c.max));
    c.slabMin -= margin;
    c.slabMax += margin;
    c.minCos -= COS_MARGIN;
    c.slope = c.slope * (1.0 + DOT_MARGIN) + DOT_MARGIN;
    // There is no cone of view rays in orthographic views, whose boxes are aligned with the rays, and
    // in very wide views, where the slope of a tile may be infinite.
    if (frameParams.projection.eyeIsPoint == 0.0 || isinf(c.slope)) {
        c.ray = vec3(0.0);
        c.slope = 0.0;
    }
    return c;
}
