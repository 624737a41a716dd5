// SPDX-License-Identifier: Apache-2.0
// Records of the probe of shading/occluder_walk.glsl (probes/occluder_walk.comp).
#ifndef CND_SHARED_WALK_PROBE_H
#define CND_SHARED_WALK_PROBE_H

#include "shared/lighting_data.h"
#include "shared/occluder_data.h"
#include "shared/probes.h"

GPU_BEGIN

const uint WALK_PROBE_INSTANCES = 3u;
const uint WALK_PROBE_NODES = 4u;
const uint WALK_PROBE_TRIANGLES = 5u;
const uint WALK_PROBE_TABLE = 6u; // engine/tables/point_table.h

struct WalkProbeParams {
    mat3 viewFromTree;
    vec3 viewInTree;
    uint count;
    uint layers, ignored;        // OccluderQuery
    uint firstNode;              // ShadowView
    uint walks;                  // 0: it only tests triangles
    uint firstTested, endTested; // of this tree: the triangles of these nodes are tested
};
GPU_SIZE(WalkProbeParams, 76)

// One receiver and one light, in view space.
struct WalkProbeInput {
    vec3 position; // m
    uint type;
    vec3 toLight; // m; distant types: unit direction
    float boundingRadius;
    LightShape shape;
    float depthError; // OccluderQuery, m
};
GPU_SIZE(WalkProbeInput, 68)

struct WalkProbeOutput {
    uvec2 members;
    uvec2 walked;  // visible points by the walk
    uvec2 tested;  // visible points by tests of the triangles that the parameters name
    uint finished; // 0: the device ended the walk
};
GPU_SIZE(WalkProbeOutput, 28)

GPU_END

#endif
