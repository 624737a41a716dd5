// SPDX-License-Identifier: Apache-2.0
// Walks the light tree without a stack: the node after a subtree follows from the number of the node.
#ifndef CND_LIB_LIGHT_TREE_WALK
#define CND_LIB_LIGHT_TREE_WALK

#include "shared/clusters.h"

// Where a walk is. It visits the nodes of the level `top`, and below those whatever it descends to.
struct TreeWalk {
    uint level;      // of the node at hand; 1: leaves
    uint index;      // of that node within its level
    uint levelFirst; // index in the node buffer of the first node of that level
    uint top;
    bool done;
};

uint treeLevelSize(TreeShape tree, uint level)
{
    const uint bits = level * TREE_WIDTH_BITS;
    return (tree.lightCount + (1u << bits) - 1u) >> bits;
}

// Stands at the first node of the highest level, or of the level `highest` where that is lower.
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

// Index in the node buffer of the node at hand.
uint treeNodeIndex(TreeWalk walk)
{
    return walk.levelFirst + walk.index;
}

// Goes to the first child of the node at hand.
void descend(TreeShape tree, inout TreeWalk walk)
{
    --walk.level;
    walk.levelFirst -= treeLevelSize(tree, walk.level);
    walk.index <<= TREE_WIDTH_BITS;
}

// Goes to the node that follows the subtree of the node at hand: the next child of its parent, or,
// from the last child, the node that follows the parent.
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
