// SPDX-License-Identifier: Apache-2.0
// Test-only: the points of lights that receivers see, by the walk through the trees and by a test of
// every triangle.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/walk_probe.h"

layout(local_size_x = PROBE_GROUP) in;
layout(push_constant, scalar) uniform Push
{
    WalkProbeParams params;
};
layout(scalar, binding = PROBE_INPUT) readonly buffer Input
{
    WalkProbeInput inputs[];
};
layout(scalar, binding = PROBE_OUTPUT) writeonly buffer Output
{
    WalkProbeOutput outputs[];
};
layout(scalar, binding = WALK_PROBE_INSTANCE_NODES) readonly buffer InstanceNodes
{
    OccluderNode instanceNodes[];
};
layout(scalar, binding = WALK_PROBE_INSTANCES) readonly buffer Instances
{
    OccluderInstance occluderInstances[];
};
layout(scalar, binding = WALK_PROBE_NODES) readonly buffer Nodes
{
    OccluderNode occluderNodes[];
};
layout(scalar, binding = WALK_PROBE_TRIANGLES) readonly buffer Triangles
{
    OccluderTriangle occluderTriangles[];
};

layout(scalar, binding = WALK_PROBE_TABLE) readonly buffer PointTable
{
    uvec2 points[];
};

uvec2 pointTable(uint i)
{
    return points[i];
}

#include "lib/visibility/light_facet.glsl"
#define QUEUE_LANES PROBE_GROUP
#include "shading/occluder_walk.glsl"

Facet facetOf(OccluderQuery q)
{
    const WalkProbeInput given = inputs[q.light];
    return lightFacet(pointCount, given.type, given.toLight, given.boundingRadius, given.shape,
                      params.viewFromTree);
}

// Tests every triangle of the leaf's instances.
void testInstances(inout OccluderWalk w, OccluderQuery q, TreeSpace tree)
{
    uint turns = 0u;
    while (leafCount(w.leaf) != 0u) {
        changeTree(w, q, tree);
        for (uint i = 0u; i < w.end; ++i) {
            uint leaf = occluderNodes[w.firstNode + i].leaf;
            for (; leafCount(leaf) != 0u; leaf = withoutFirst(leaf))
                w.lit &= ~pointsHiddenBy(w, leafFirst(leaf), turns);
        }
    }
}

uvec2 visibleByTests(OccluderQuery q, TreeSpace tree)
{
    OccluderWalk w = walkFromRoot();
    for (uint i = 0u; i < instanceNodes[0].skip; ++i) {
        w.leaf = instanceNodes[i].leaf;
        testInstances(w, q, tree);
    }
    return w.lit;
}

void main()
{
    const uint i = gl_GlobalInvocationID.x;
    // Lanes without an input take the last one, because the walk ends by a vote.
    OccluderQuery q;
    q.light = min(i, params.count - 1u);
    q.position = inputs[q.light].position;
    q.depthError = 0.0;
    q.layers = params.layers;
    q.ignored = params.ignored;
    const TreeSpace tree = TreeSpace(params.viewFromTree, params.viewInTree);
    bool isFinished;
    const uvec2 walked = visiblePoints(q, tree, true, isFinished);
    const uvec2 tested = visibleByTests(q, tree);
    if (i < params.count)
        outputs[i] = WalkProbeOutput(facetOf(q).members, walked, tested);
}
