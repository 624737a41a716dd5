// SPDX-License-Identifier: Apache-2.0
// Reads nodes of the light tree.
#ifndef CND_COMMON_LIGHT_TREE
#define CND_COMMON_LIGHT_TREE

#include "lib/light_tree_walk.glsl"
#include "lib/bounds.glsl"
#include "shading/software_drivers.glsl"

layout(binding = TREE_NODE_TEXELS) uniform textureBuffer treeTexels;
layout(scalar, binding = TREE_NODES) readonly buffer TreeWords
{
    vec4 treeWords[];
};

// Returns the box with this index in the node buffer.
Box treeBox(uint node)
{
    const uint at = node * TREE_NODE_STRIDE;
    return Box(READ(treeWords, treeTexels, at).xyz, READ(treeWords, treeTexels, at + 1u).xyz);
}

Box treeNode(TreeWalk walk)
{
    return treeBox(treeNodeIndex(walk));
}

#endif
