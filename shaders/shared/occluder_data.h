// SPDX-License-Identifier: Apache-2.0
// What casts shadows, as kernels see it: meshes of triangles with their trees, and instances of
// them with a tree over all.
#ifndef CND_SHARED_OCCLUDER_DATA_H
#define CND_SHARED_OCCLUDER_DATA_H

#include "shared/prelude.h"

GPU_BEGIN

// A node of a tree over triangles or over instances. The nodes of a tree are stored depth first. A
// walk begins at index 0 and goes to the next index from an inner node whose box it touches, and to
// `skip` from any other node. It ends at the `skip` of the root, which is the number of nodes.
// Indices of nodes, triangles and instances are relative to the first of the same tree.
struct OccluderNode {
    vec3 low;
    uint skip;
    vec3 high;
    uint leaf; // 0: inner; otherwise the first triangle or instance << OCCLUDER_LEAF_SHIFT, plus
               //   how many there are
};
GPU_SIZE(OccluderNode, 32)
const uint OCCLUDER_LEAF_SHIFT = 3u;
const uint OCCLUDER_LEAF_COUNT = 7u;     // mask of the count
const uint OCCLUDER_LEAF_TRIANGLES = 4u; // at most
const uint OCCLUDER_LEAF_INSTANCES = 3u;

// In the mesh's own space.
struct OccluderTriangle {
    vec3 corners[3];
};
GPU_SIZE(OccluderTriangle, 36)

// An instance as the CPU sends it, at its place in the order of the tree over instances.
struct OccluderRecord {
    mat3 worldFromLocal;
    vec3 positionHi; // of the mesh's origin in the world, as the sum of two floats
    vec3 positionLo;
    uint firstNode; // of the mesh
    uint firstTriangle;
    uint flags;         // layers (shared/lighting_data.h); plus 1 << occluder layer <<
                        //   OCCLUDER_LAYERS_SHIFT; 0: no instance has this place
    float surfaceError; // m
};
GPU_SIZE(OccluderRecord, 76)
const uint OCCLUDER_LAYERS_SHIFT = 16u;
const uint OCCLUDER_LAYER_COUNT = 6u;

// The same as prepare_occluders writes it. A point x of view space is at localFromView x +
// viewInLocal in the mesh's own space.
struct OccluderInstance {
    mat3 viewFromLocal;
    vec3 localInView; // position of the mesh's origin
    mat3 localFromView;
    vec3 viewInLocal; // position of the origin of view space
    uint firstNode;
    uint firstTriangle;
    uint flags;
    float surfaceError;
};
GPU_SIZE(OccluderInstance, 112)

// --- prepare_occluders: transforms instances to view space, one lane per instance
const uint PREPARE_OCCLUDERS_GROUP = 64u;
const uint PREPARE_OCCLUDERS_RECORDS = 0u;
const uint PREPARE_OCCLUDERS_INSTANCES = 1u;
struct PrepareOccludersParams {
    mat3 viewFromWorld; // rotation
    vec3 cameraHi;      // the camera's position in the world, as the sum of two floats
    vec3 cameraLo;
    uint count; // of records
};
GPU_SIZE(PrepareOccludersParams, 64)

GPU_END

#endif
