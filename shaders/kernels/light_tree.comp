// SPDX-License-Identifier: Apache-2.0
// Builds two levels of the light tree from the level below. A lane makes one node of the upper level
// and its children.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/clusters.h"
#define LIGHT_STREAM_CORE LIGHT_TREE_CORE
#define LIGHT_STREAM_CORE_WORDS LIGHT_TREE_CORE_WORDS
#include "kernels/common/light_stream.glsl"

layout(local_size_x = LIGHT_TREE_GROUP) in;
layout(push_constant, scalar) uniform Push
{
    LightTreeParams params;
};
layout(scalar, binding = LIGHT_TREE_NODES) buffer Nodes
{
    vec4 nodes[];
};

// Bound of a box's coordinates. It stands for infinity, but its product with 0 is 0.
const float LARGEST = 1e30;

// A box is enlarged by this share of its light's centre and influence radius, so that neither rounding
// here nor in the tests of the box loses a light.
const float BOX_MARGIN = 1.0 / 1048576.0;

void childBox(uint child, out vec3 lowest, out vec3 highest)
{
    if (params.fromLights == 0u) {
        lowest = nodes[child * TREE_NODE_STRIDE].xyz;
        highest = nodes[child * TREE_NODE_STRIDE + 1u].xyz;
        return;
    }
    lowest = vec3(LARGEST);
    highest = vec3(-LARGEST);
    if (lightEmission(child).w <= 0.0) // not a light (device_lights), or a light of other layers
        return;
    const vec3 centre = lightCentre(child).xyz;
    const vec3 size = abs(centre);
    const float r = min(sqrt(lightEmission(child).w), LARGEST);
    const float widened = r + BOX_MARGIN * (r + max(size.x, max(size.y, size.z)));
    lowest = centre - widened;
    highest = centre + widened;
}

void writeNode(uint node, vec3 lowest, vec3 highest)
{
    nodes[node * TREE_NODE_STRIDE] = vec4(max(lowest, vec3(-LARGEST)), 0.0);
    nodes[node * TREE_NODE_STRIDE + 1u] = vec4(min(highest, vec3(LARGEST)), 0.0);
}

void main()
{
    const uint upper = gl_GlobalInvocationID.x;
    const uint first = upper * TREE_WIDTH * TREE_WIDTH;
    if (first >= params.childCount)
        return;
    vec3 upperLowest = vec3(LARGEST), upperHighest = vec3(-LARGEST);
    for (uint i = 0u; i < TREE_WIDTH; ++i) {
        const uint firstChild = first + i * TREE_WIDTH;
        if (firstChild >= params.childCount)
            break;
        const uint end = min(firstChild + TREE_WIDTH, params.childCount);
        vec3 lowest = vec3(LARGEST), highest = vec3(-LARGEST);
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
