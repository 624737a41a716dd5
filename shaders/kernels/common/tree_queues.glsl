// SPDX-License-Identifier: Apache-2.0
// A walk of a group of lanes (lane_group.glsl) through the light tree. In each turn the lanes take up
// to PARENTS nodes of one level that the cluster touches, and each lane tests up to TESTS_PER_LANE of
// their children.
//
// Each level has a queue of touched nodes whose children have not been tested. Nodes leave a queue in
// the order in which they entered it, and they come from the level above alone. So every queue holds
// nodes in ascending order, and lights are found in ascending order, whichever level a turn takes. It
// takes the lowest level that has PARENTS nodes. If none has as many, it takes the highest level that
// has nodes, so that the queues below fill up. So nearly all turns have work for all lanes. No queue
// ever holds more than PARENTS - 1 + PARENTS * TREE_WIDTH nodes: those that were too few for a turn,
// and the children of one turn.
#ifndef CND_COMMON_TREE_QUEUES
#define CND_COMMON_TREE_QUEUES

#include "kernels/common/lane_group.glsl"
#include "lib/light_tree_walk.glsl"

// How many nodes or lights a lane tests in a turn. What they read of memory arrives together, so two
// take less than twice as long as one. list_by_group.glsl is written for two.
const uint TESTS_PER_LANE = 2u;
const uint PARENTS = TESTS_PER_LANE * LANES / TREE_WIDTH;
const uint QUEUE_PLACES = PARENTS + PARENTS * TREE_WIDTH;

// Place p of the queue of level k is treeQueues[(k - 1) * QUEUE_PLACES + p]: the index of a node in its
// level.
shared uint treeQueues[TREE_LEVELS * QUEUE_PLACES];
// Index in the node buffer of the first node of level k: levelFirst[k - 1].
shared uint levelFirst[TREE_LEVELS];

struct TreeTurn {
    // Eight bits per queue: how many nodes it holds, and the place of the first of them.
    uvec2 held, heads;
    uint root;    // level of the root, which is above the highest nodes and has no box
    uint level;   // level of the nodes whose children this turn tests
    uint parents; // number of these nodes; 0: the walk is complete
};

uint queueByte(uvec2 bytes, uint level)
{
    const uint queue = level - 1u;
    return ((queue < 4u ? bytes.x : bytes.y) >> (queue % 4u * 8u)) & 255u;
}

void addToQueueByte(inout uvec2 bytes, uint level, uint value)
{
    const uint queue = level - 1u, shifted = value << (queue % 4u * 8u);
    bytes += queue < 4u ? uvec2(shifted, 0u) : uvec2(0u, shifted);
}

// Returns the place `steps` after the first node of a queue; `steps` <= QUEUE_PLACES.
uint queuePlace(TreeTurn t, uint level, uint steps)
{
    const uint place = queueByte(t.heads, level) + steps;
    return place < QUEUE_PLACES ? place : place - QUEUE_PLACES;
}

// Begins with the children of the root.
TreeTurn firstTurn(TreeShape tree)
{
    uint node = tree.firstNode, root = 2u;
    for (uint level = 1u; level <= TREE_LEVELS; ++level) {
        if (lane == 0u)
            levelFirst[level - 1u] = node;
        node += treeLevelSize(tree, level);
        root += treeLevelSize(tree, level) > TREE_WIDTH ? 1u : 0u;
    }
    syncLanes();
    return TreeTurn(uvec2(0u), uvec2(0u), root, root, tree.lightCount == 0u ? 0u : 1u);
}

// Returns the index in its level of the child number `at` of those that this turn tests, or sets
// `exists` to false.
uint childOfTurn(TreeTurn t, uint levelSize, uint at, out bool exists)
{
    uint parent = 0u;
    if (t.level != t.root) {
        const uint place = queuePlace(t, t.level, at / TREE_WIDTH);
        parent = treeQueues[(t.level - 1u) * QUEUE_PLACES + place];
    }
    const uint child = parent * TREE_WIDTH + at % TREE_WIDTH;
    exists = at < t.parents * TREE_WIDTH && child < levelSize;
    return exists ? child : 0u;
}

// Appends the children that are touched to the queue of their level.
void enqueue(inout TreeTurn t, uint child, bool touched)
{
    const uint lanes = lanesThatSay(touched);
    const uint level = t.level - 1u;
    const uint place = queuePlace(t, level, queueByte(t.held, level) + lanesBefore(lanes));
    if (touched)
        treeQueues[(level - 1u) * QUEUE_PLACES + place] = child;
    addToQueueByte(t.held, level, uint(bitCount(lanes)));
}

// Removes the nodes whose children have been tested, and chooses those of the next turn.
void nextTurn(inout TreeTurn t)
{
    if (t.level != t.root) {
        const uint next = queuePlace(t, t.level, t.parents);
        addToQueueByte(t.heads, t.level, next - queueByte(t.heads, t.level));
        addToQueueByte(t.held, t.level, 0u - t.parents);
    }
    const uvec2 whole = t.held & (0x01010101u * (256u - PARENTS));
    t.level = whole.x != 0u    ? uint(findLSB(whole.x)) / 8u + 1u
              : whole.y != 0u  ? uint(findLSB(whole.y)) / 8u + 5u
              : t.held.y != 0u ? uint(findMSB(t.held.y)) / 8u + 5u
              : t.held.x != 0u ? uint(findMSB(t.held.x)) / 8u + 1u
                               : 1u;
    t.parents = min(queueByte(t.held, t.level), PARENTS);
    syncLanes();
}

#endif
