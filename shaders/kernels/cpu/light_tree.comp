// SPDX-License-Identifier: Apache-2.0
// The form of light_tree for llvmpipe: a lane makes a node of the upper level and its children.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernels/common/tree_levels.glsl"

layout(local_size_x = LIGHT_TREE_GROUP) in;

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
