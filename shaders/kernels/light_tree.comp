// SPDX-License-Identifier: Apache-2.0
// Builds two levels of the light tree from the level below. A lane makes one node of the upper level
// and its children.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/clusters.h"
#define LIGHT_STREAM_CORE LIGHT_TREE_CORE
#define LIGHT_STREAM_CORE_WORDS LIGHT_TREE_CORE_WORDS
#include "kernels/common/light_stream.glsl"
#include "lib/bounds.glsl"

layout(local_size_x = LIGHT_TREE_GROUP) in;
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

void main()
{
    const uint upper = gl_GlobalInvocationID.x;
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
