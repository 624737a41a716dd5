// SPDX-License-Identifier: Apache-2.0
// Builds two levels of the light tree from the level below. A group makes one node of the upper level
// and its children, and each lane reads one child of these.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernels/common/tree_levels.glsl"

layout(local_size_x = LIGHT_TREE_GROUP) in;

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

void main()
{
    const uint upper = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
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
