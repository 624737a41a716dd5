// SPDX-License-Identifier: Apache-2.0
// refit_occluders: fits the boxes of a tree of occluders to what is in its leaves, one work group
// per group of the tree's plan: an array of words (engine/occluders/refit_plan.h).
#ifndef CND_SHARED_REFIT_OCCLUDERS_H
#define CND_SHARED_REFIT_OCCLUDERS_H

#include "shared/occluder_data.h"

GPU_BEGIN

const uint REFIT_OCCLUDERS_GROUP = 64u;
const uint REFIT_OCCLUDERS_NODES = 0u;
const uint REFIT_OCCLUDERS_TRIANGLES = 1u;
const uint REFIT_OCCLUDERS_PLAN = 2u;
const uint REFIT_OCCLUDERS_POSITIONS = 3u; // words
const uint REFIT_OCCLUDERS_RECORDS = 4u;

// Which nodes are fitted: specialisation constant.
const uint SPEC_REFIT = 0u;
const uint REFIT_MESH_LEAVES = 0u;     // also writes their triangles, from positions on the device
const uint REFIT_INSTANCE_LEAVES = 1u; // of the tree over instances
const uint REFIT_INNER_NODES = 2u;     // of any tree, after its leaves
const uint REFIT_KINDS = 3u;

struct RefitOccludersParams {
    vec3 originHi; // of the tree over instances in the world, as the sum of two floats
    vec3 originLo;
    uint firstNode; // of the tree
    uint plan;      // its first word
    uint firstGroup, groupCount;
    uint firstRound;    // of inner nodes
    uint firstTriangle; // of a mesh
    uint corners;       // first word of the indices of its vertices, three per triangle
    uint positions;     // word of its first vertex
    uint stride;        // words from one vertex to the next
};
GPU_SIZE(RefitOccludersParams, 60)
const float MAX_OCCLUDER_COORDINATE = 1e15f; // of positions in meshes

GPU_END

#endif
