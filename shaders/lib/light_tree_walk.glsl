// SPDX-License-Identifier: Apache-2.0
// Walks the light tree without a stack: the node after a subtree follows from the number of the node.
#ifndef CND_LIB_LIGHT_TREE_WALK
#define CND_LIB_LIGHT_TREE_WALK

#include "shared/clusters.h"

struct TreeWalk {
    uint level; // of the node at hand; 1: leaves
    uint index; // within its level
    bool done;
};

// First node of each level (index 0 is not used), and the number of levels.
uint treeLevelFirst[TREE_LEVELS + 1u];
uint treeTop;

uint treeLevelSize(TreeShape tree, uint level)
{
    const uint bits = level * TREE_WIDTH_BITS;
    return (tree.lightCount + (1u << bits) - 1u) >> bits;
}

// At the first node of the highest level.
TreeWalk beginTreeWalk(TreeShape tree)
{
    uint first = tree.firstNode;
    treeTop = 0u;
    for (uint level = 1u; level <= TREE_LEVELS; ++level) {
        const uint size = treeLevelSize(tree, level);
        treeLevelFirst[level] = first;
        first += size;
        treeTop = treeTop == 0u && size <= TREE_WIDTH ? level : treeTop;
    }
    return TreeWalk(treeTop, 0u, tree.lightCount == 0u);
}

// In the node buffer.
uint treeNodeIndex(TreeWalk walk)
{
    return treeLevelFirst[walk.level] + walk.index;
}

void descend(inout TreeWalk walk)
{
    --walk.level;
    walk.index <<= TREE_WIDTH_BITS;
}

// To the node behind the subtree at hand.
void skipSubtree(TreeShape tree, inout TreeWalk walk)
{
    ++walk.index;
    walk.done = walk.index >= treeLevelSize(tree, walk.level);
    const uint up = min(uint(findLSB(walk.index)) / TREE_WIDTH_BITS, treeTop - walk.level);
    walk.level += up;
    walk.index >>= up * TREE_WIDTH_BITS;
}

#endif
