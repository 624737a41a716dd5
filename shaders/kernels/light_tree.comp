// SPDX-License-Identifier: Apache-2.0
// Builds two levels of the light tree from the level below. On GPUs a group makes one node of the upper
// level and its children, and each lane reads one child of these. On llvmpipe a lane makes all that by
// itself.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/cluster_data.h"
#define LIGHT_STREAM_CORE LIGHT_TREE_CORE
#define LIGHT_STREAM_CORE_WORDS LIGHT_TREE_CORE_WORDS
#include "kernels/common/light_stream.glsl"
#include "lib/bounds.glsl"

layout(local_size_x = LIGHT_TREE_GROUP) in;
layout(constant_id = SPEC_LANES_TOGETHER) const bool lanesTogether = true;
layout(push_constant, scalar) uniform Push
{
    LightTreeParams params;
};
layout(scalar, binding = LIGHT_TREE_NODES) buffer Nodes
{
    vec4 nodes[];
};

void childBox(uint child, out vec3 lowest, out vec3 highest)
{
    if (params.fromLights == 0u) {
        lowest = nodes[child * TREE_NODE_STRIDE].xyz;
        highest = nodes[child * TREE_NODE_STRIDE + 1u].xyz;
        return;
    }
    lowest = vec3(UNBOUNDED);
    highest = vec3(-UNBOUNDED);
    if (lightEmission(child).w <= 0.0) // not a light (device_lights), or a light of other layers
        return;
    const Box box = influenceBox(lightCentre(child).xyz, lightEmission(child).w);
    lowest = box.min;
    highest = box.max;
}

void writeNode(uint node, vec3 lowest, vec3 highest)
{
    nodes[node * TREE_NODE_STRIDE] = vec4(lowest, 0.0);
    nodes[node * TREE_NODE_STRIDE + 1u] = vec4(highest, 0.0);
}

// A lane makes a node of the upper level and its children.
void makeNodesOfLane(uint upper)
{
    const uint first = upper * TREE_WIDTH * TREE_WIDTH;
    if (first >= params.childCount)
        return;
    vec3 upperLowest = vec3(UNBOUNDED), upperHighest = vec3(-UNBOUNDED);
    for (uint i = 0u; i < TREE_WIDTH; ++i) {
        const uint firstChild = first + i * TREE_WIDTH;
        if (firstChild >= params.childCount)
            break;
        const uint end = min(firstChild + TREE_WIDTH, params.childCount);
        vec3 lowest = vec3(UNBOUNDED), highest = vec3(-UNBOUNDED);
        for (uint child = firstChild; child < end; ++child) {
            vec3 childLowest, childHighest;
            childBox(params.childFirst + child, childLowest, childHighest);
            lowest = min(lowest, childLowest);
            highest = max(highest, childHighest);
        }
        writeNode(params.lowerFirst + firstChild / TREE_WIDTH, lowest, highest);
        upperLowest = min(upperLowest, lowest);
        upperHighest = max(upperHighest, highest);
    }
    writeNode(params.upperFirst + upper, upperLowest, upperHighest);
}

// The boxes of the children that the lanes of a group read, then of each node in the place of its first
// child.
shared vec3 lowestOfLane[LIGHT_TREE_GROUP], highestOfLane[LIGHT_TREE_GROUP];

// Returns the box around TREE_WIDTH boxes, each `step` places after the one before.
void mergeBoxes(uint place, uint step, out vec3 lowest, out vec3 highest)
{
    lowest = lowestOfLane[place];
    highest = highestOfLane[place];
    for (uint i = 1u; i < TREE_WIDTH; ++i) {
        lowest = min(lowest, lowestOfLane[place + i * step]);
        highest = max(highest, highestOfLane[place + i * step]);
    }
}

void makeNodesOfGroup(uint upper)
{
    const uint first = upper * LIGHT_TREE_GROUP;
    if (first >= params.childCount)
        return;
    const uint lane = gl_LocalInvocationIndex;
    vec3 lowest = vec3(UNBOUNDED), highest = vec3(-UNBOUNDED);
    if (first + lane < params.childCount)
        childBox(params.childFirst + first + lane, lowest, highest);
    lowestOfLane[lane] = lowest;
    highestOfLane[lane] = highest;
    barrier();
    const uint place = lane * TREE_WIDTH;
    if (lane < TREE_WIDTH) {
        mergeBoxes(place, 1u, lowest, highest);
        if (first + place < params.childCount)
            writeNode(params.lowerFirst + first / TREE_WIDTH + lane, lowest, highest);
        lowestOfLane[place] = lowest;
        highestOfLane[place] = highest;
    }
    barrier();
    if (lane == 0u) {
        mergeBoxes(0u, TREE_WIDTH, lowest, highest);
        writeNode(params.upperFirst + upper, lowest, highest);
    }
}

void main()
{
    if (lanesTogether)
        makeNodesOfGroup(gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x);
    else
        makeNodesOfLane(gl_GlobalInvocationID.x);
}
