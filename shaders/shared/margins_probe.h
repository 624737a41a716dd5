// SPDX-License-Identifier: Apache-2.0
// Records that cross between tests/gpu/test_cluster_margins.cpp and probes/cluster_margins.comp.
#ifndef CND_SHARED_MARGINS_PROBE_H
#define CND_SHARED_MARGINS_PROBE_H

#include "shared/frame.h"
#include "shared/probes.h"

GPU_BEGIN

// A cluster of a few samples near one pixel.
struct MarginsProbeInput {
    Projection projection;
    vec2 invImageSize;
    uvec2 pixel;
    float depth;
    float depthRange; // depths of the samples are between depth and depth * (1 + depthRange)
    float reach;      // m; the lights have up to this radius of influence
    uint seed;
};
GPU_SIZE(MarginsProbeInput, 88)

// Counts of the lights that reach a sample where another pipeline may place it.
struct MarginsProbeOutput {
    uint reaching;
    uint missed;             // left out by the tests of clusters or of nodes of the light tree
    uint missedIfNotWidened; // left out by the tests of bounds without margins
    // The bounds give a sphere a height that holds at all samples (heightOfSphere). `tooHigh`
    // counts spheres that are a millionth too large to have that height at one sample. `high`
    // counts spheres that are 1% smaller than the largest sphere with that height at the sample,
    // and to which the bounds give it.
    uint tooHigh, high;
};
GPU_SIZE(MarginsProbeOutput, 20)

GPU_END

#endif
