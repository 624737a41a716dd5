// SPDX-License-Identifier: Apache-2.0
// Bounds of surface samples: a box, a slab along an axis near their normals, a cone of normals and a
// cone of view rays. They are made from the exact positions instead of a slice of the frustum, so that
// lights are culled against the surfaces that are there.
#ifndef CND_COMMON_CLUSTER_BOUNDS
#define CND_COMMON_CLUSTER_BOUNDS

#include "shared/cluster_data.h"
#include "lib/cluster_margins.glsl"
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
    return texelFetch(depthImage, depthTexelOf(pixel), 0).x;
}

// The functions take the parameters of the frame as an argument, which callers copy from the uniform
// buffer before they loop over samples (shading/software_drivers.glsl).
Cluster emptyCluster(FrameParams frame, uint tile)
{
    const uvec2 middle = firstPixelOfTile(tile, frame.size.x) + TILE_SIZE / 2u;
    const vec3 ray = viewRay(frame.projection, middle, frame.invImageSize);
    return Cluster(vec3(UNBOUNDED), tile, vec3(-UNBOUNDED), 0u, vec3(0.0), UNBOUNDED, -UNBOUNDED, 1.0,
                   0xFFFFFFFFu, normalize(ray), 0.0);
}

bool isEmpty(Cluster c)
{
    return c.min.x > c.max.x;
}

struct Sample {
    vec3 position, normal;
    uint depthBits;
};

Sample readSample(FrameParams frame, uvec2 pixel, float depth)
{
    return Sample(viewPosition(frame.projection, pixel, frame.invImageSize, depth),
                  readNormal(pixel), depthBits(depth));
}

// Adds a sample to a cluster, which has its axis.
void addSample(inout Cluster c, Sample s)
{
    c.depthBits = min(c.depthBits, s.depthBits);
    c.min = min(c.min, s.position);
    c.max = max(c.max, s.position);
    const float along = dot(c.axis, s.position);
    c.slabMin = min(c.slabMin, along);
    c.slabMax = max(c.slabMax, along);
    c.minCos = min(c.minCos, dot(c.axis, s.normal));
    const float ahead = dot(s.position, c.ray);
    const float aside = length(cross(s.position, c.ray));
    c.slope = max(c.slope, aside < MAX_SLOPE * ahead ? aside / ahead : MAX_SLOPE);
}

#endif
