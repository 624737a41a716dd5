// SPDX-License-Identifier: Apache-2.0
// Test-only: the points of lights that receivers see, by the walk through the trees and by tests of
// triangles. Some devices end loops early (DECISIONS 12), so a dispatch tests a part of the triangles.
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
layout(scalar, binding = WALK_PROBE_INSTANCES) readonly buffer Instances
{
    OccluderInstance instances[];
};
layout(scalar, binding = WALK_PROBE_NODES) readonly buffer Nodes
{
    OccluderNode nodes[];
};
layout(scalar, binding = WALK_PROBE_TRIANGLES) readonly buffer Triangles
{
    OccluderTriangle triangles[];
};

OccluderInstance occluderInstance(uint at)
{
    return instances[at];
}
OccluderNode occluderNode(uint at)
{
    return nodes[at];
}
OccluderTriangle occluderTriangle(uint at)
{
    return triangles[at];
}

layout(scalar, binding = WALK_PROBE_TABLE) readonly buffer PointTable
{
    uvec2 points[];
};

uvec2 pointTable(uint i)
{
    return points[i];
}

#include "lib/visibility/light_facet.glsl"
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
        changeTree(w, q, tree, true);
        const uint flags = occluderInstance(w.instance).flags;
        const bool counts = (flags & q.layers) != 0u && (flags & q.ignored) == 0u;
        for (uint i = 0u; counts && i < w.end; ++i) {
            uint leaf = occluderNode(w.firstNode + i).leaf;
            for (; leafCount(leaf) != 0u; leaf = withoutFirst(leaf))
                w.lit &= ~pointsHiddenBy(w, leafFirst(leaf), turns);
        }
    }
}

uvec2 visibleByTests(OccluderQuery q, TreeSpace tree)
{
    OccluderWalk w = walkFromRoot();
    for (uint i = params.firstTested; i < params.endTested; ++i) {
        w.leaf = occluderNode(tree.firstNode + i).leaf;
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
    q.depthError = inputs[q.light].depthError;
    q.layers = params.layers;
    q.ignored = params.ignored;
    const TreeSpace tree = TreeSpace(params.viewFromTree, params.viewInTree, params.firstNode);
    bool isFinished = true;
    uvec2 walked = uvec2(0u);
    if (params.walks != 0u)
        walked = visiblePoints(q, tree, true, isFinished);
    const uvec2 tested = visibleByTests(q, tree);
    if (i < params.count)
        outputs[i] = WalkProbeOutput(facetOf(q).members, walked, tested, isFinished ? 1u : 0u);
}
