// SPDX-License-Identifier: Apache-2.0
// Reads and writes nodes while light_tree builds two levels of the light tree from the level below.
#ifndef CND_COMMON_TREE_LEVELS
#define CND_COMMON_TREE_LEVELS

#include "shared/cluster_data.h"
#include "kernels/common/light_stream.glsl"
#include "lib/bounds.glsl"

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

#endif
