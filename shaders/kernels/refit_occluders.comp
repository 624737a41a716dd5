// SPDX-License-Identifier: Apache-2.0
// Fits the boxes of a tree of occluders to triangles or instances that have moved: first its leaves,
// then the nodes of subtrees, a group's round by round, and in a third dispatch those above them.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/camera_relative.glsl"
#include "shading/occluder_leaf.glsl"
#include "shared/refit_occluders.h"

// A pipeline for each, because llvmpipe also runs code that it skips.
layout(constant_id = SPEC_REFIT) const uint kind = REFIT_MESH_LEAVES;

layout(local_size_x = REFIT_OCCLUDERS_GROUP) in;
layout(push_constant, scalar) uniform Push
{
    RefitOccludersParams params;
};
layout(scalar, binding = REFIT_OCCLUDERS_NODES) coherent buffer Nodes
{
    OccluderNode nodes[];
};
layout(scalar, binding = REFIT_OCCLUDERS_TRIANGLES) writeonly buffer Triangles
{
    OccluderTriangle triangles[];
};
layout(scalar, binding = REFIT_OCCLUDERS_PLAN) readonly buffer Plan
{
    uint plan[];
};
layout(scalar, binding = REFIT_OCCLUDERS_POSITIONS) readonly buffer Positions
{
    uint positions[];
};
layout(scalar, binding = REFIT_OCCLUDERS_RECORDS) readonly buffer Records
{
    OccluderRecord records[];
};

struct Box {
    vec3 low, high;
};

Box joined(Box a, Box b)
{
    return Box(min(a.low, b.low), max(a.high, b.high));
}

// A coordinate that is not finite or too large counts as 0, and so does -0.
float coordinate(uint bits)
{
    const uint size = bits & 0x7FFFFFFFu;
    return size == 0u || size > floatBitsToUint(MAX_OCCLUDER_COORDINATE) ? 0.0 : uintBitsToFloat(bits);
}

vec3 positionOf(uint vertex)
{
    const uint at = params.positions + vertex * params.stride;
    return vec3(coordinate(positions[at]), coordinate(positions[at + 1u]),
                coordinate(positions[at + 2u]));
}

// Writes a triangle and returns its box.
Box writeTriangle(uint triangle)
{
    const uint at = params.corners + 3u * triangle;
    const vec3 a = positionOf(plan[at]), b = positionOf(plan[at + 1u]), c = positionOf(plan[at + 2u]);
    triangles[params.firstTriangle + triangle] = OccluderTriangle(vec3[3](a, b, c));
    return Box(min(a, min(b, c)), max(a, max(b, c)));
}

// Returns the box of an instance relative to the origin of its tree. It is wider by what a float32
// transform of the mesh's points and the arithmetic here may add.
Box boxOfInstance(OccluderRecord r)
{
    const OccluderNode root = nodes[r.firstNode];
    const vec3 position =
        cameraRelative(r.positionHi, r.positionLo, params.originHi, params.originLo);
    const vec3 middle = 0.5 * root.low + 0.5 * root.high, size = 0.5 * root.high - 0.5 * root.low;
    const vec3 farthest = max(abs(root.low), abs(root.high));
    const mat3 m = r.worldFromLocal;
    const mat3 a = mat3(abs(m[0]), abs(m[1]), abs(m[2]));
    const float lost = 1.4210854715202004e-14; // 2^-46: of positions as sums of two floats
    const vec3 half_ = a * size + 4e-6 * (abs(position) + a * farthest) +
                       lost * (abs(r.positionHi) + abs(params.originHi));
    const vec3 centre = position + m * middle;
    return Box(centre - half_, centre + half_);
}

Box boxOfMeshLeaf(uint leaf)
{
    Box box = writeTriangle(leafFirst(leaf));
    for (uint i = 1u; i < OCCLUDER_LEAF_TRIANGLES; ++i)
        if (i < leafCount(leaf))
            box = joined(box, writeTriangle(leafFirst(leaf) + i));
    return box;
}

// Places without an instance are left out. A leaf with no other keeps its box.
Box boxOfInstanceLeaf(OccluderNode node)
{
    Box box = Box(node.low, node.high);
    bool isEmpty = true;
    for (uint i = 0u; i < OCCLUDER_LEAF_INSTANCES; ++i)
        if (i < leafCount(node.leaf)) {
            const OccluderRecord record = records[leafFirst(node.leaf) + i];
            if (record.flags != 0u) {
                const Box added = boxOfInstance(record);
                box = isEmpty ? added : joined(box, added);
                isEmpty = false;
            }
        }
    return box;
}

Box boxOfInnerNode(uint at)
{
    const OccluderNode a = nodes[at + 1u], b = nodes[params.firstNode + a.skip];
    return joined(Box(a.low, a.high), Box(b.low, b.high));
}

void fit(uint at)
{
    const Box box = kind == REFIT_INNER_NODES       ? boxOfInnerNode(at)
                    : kind == REFIT_INSTANCE_LEAVES ? boxOfInstanceLeaf(nodes[at])
                                                    : boxOfMeshLeaf(nodes[at].leaf);
    nodes[at].low = box.low;
    nodes[at].high = box.high;
}

void main()
{
    const uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    if (group >= params.groupCount)
        return;
    const uint at = params.plan + plan[params.plan + params.firstGroup + group];
    const uint rounds = kind == REFIT_INNER_NODES ? plan[at] : 1u; // leaves are the first round
    uint from = at + 1u + plan[at];
    // No loop differs between lanes.
    for (uint r = 0u; r < rounds; ++r) {
        const uint end = from + plan[at + 1u + r];
        if (kind != REFIT_INNER_NODES || r >= params.firstRound) {
            for (uint first = from; first < end; first += REFIT_OCCLUDERS_GROUP)
                if (first + gl_LocalInvocationIndex < end)
                    fit(params.firstNode + plan[first + gl_LocalInvocationIndex]);
            if (kind == REFIT_INNER_NODES) {
                memoryBarrierBuffer();
                barrier();
            }
        }
        from = end;
    }
}
