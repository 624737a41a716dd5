// SPDX-License-Identifier: Apache-2.0
// Reads nodes of the light tree in the same way as light_stream.glsl reads lights. Include it after
// that file. The includer defines the binding ids TREE_NODES and TREE_NODE_WORDS.
#ifndef CND_COMMON_LIGHT_TREE
#define CND_COMMON_LIGHT_TREE

#include "lib/light_tree_walk.glsl"
#include "lib/bounds.glsl"

layout(binding = TREE_NODES) uniform textureBuffer treeTexels;
layout(scalar, binding = TREE_NODE_WORDS) readonly buffer TreeWords
{
    vec4 treeWords[];
};

// Returns the box with this index in the node buffer.
Box treeBox(uint node)
{
    const uint at = node * TREE_NODE_STRIDE;
    if (lightsAsTexels != 0u)
        return Box(texelFetch(treeTexels, int(at)).xyz, texelFetch(treeTexels, int(at + 1u)).xyz);
    return Box(treeWords[at].xyz, treeWords[at + 1u].xyz);
}

Box treeNode(TreeWalk walk)
{
    return treeBox(treeNodeIndex(walk));
}

#endif
