// SPDX-License-Identifier: Apache-2.0
// Walks the light tree without a stack: the node after a subtree follows from the index of the
// subtree's root.
#ifndef CND_LIB_LIGHT_TREE_WALK
#define CND_LIB_LIGHT_TREE_WALK

#include "shared/cluster_data.h"

// The state of a walk, which stands at one node. It visits all nodes of the level `top`, and below them
// the nodes that it descends to.
struct TreeWalk {
    uint level;      // level of the present node; 1: leaves
    uint index;      // index of the present node in its level
    uint levelFirst; // index in the node buffer of the first node of that level
    uint top;
    bool done;       // there are no more nodes
};

// Returns the number of nodes of a level.
uint treeLevelSize(TreeShape tree, uint level)
{
    const uint bits = level * TREE_WIDTH_BITS;
    return (tree.lightCount + (1u << bits) - 1u) >> bits;
}

// Begins a walk at the first node of the tree's highest level, or of the level `highest` if that is
// lower.
TreeWalk beginTreeWalk(TreeShape tree, uint highest)
{
    TreeWalk walk = TreeWalk(1u, 0u, tree.firstNode, 1u, tree.lightCount == 0u);
    while (walk.level < highest && treeLevelSize(tree, walk.level) > TREE_WIDTH) {
        walk.levelFirst += treeLevelSize(tree, walk.level);
        ++walk.level;
    }
    walk.top = walk.level;
    return walk;
}

// Returns the index in the node buffer of the present node.
uint treeNodeIndex(TreeWalk walk)
{
    return walk.levelFirst + walk.index;
}

// Goes to the first child of the present node.
void descend(TreeShape tree, inout TreeWalk walk)
{
    --walk.level;
    walk.levelFirst -= treeLevelSize(tree, walk.level);
    walk.index <<= TREE_WIDTH_BITS;
}

// Goes to the node that follows the subtree of the present node: the next child of its parent or, after
// the last child, the node that follows the parent's subtree.
void skipSubtree(TreeShape tree, inout TreeWalk walk)
{
    ++walk.index;
    walk.done = walk.index >= treeLevelSize(tree, walk.level);
    while (walk.index % TREE_WIDTH == 0u && walk.level < walk.top) {
        walk.levelFirst += treeLevelSize(tree, walk.level);
        ++walk.level;
        walk.index >>= TREE_WIDTH_BITS;
    }
}

#endif
