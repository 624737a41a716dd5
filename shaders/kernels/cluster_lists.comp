// SPDX-License-Identifier: Apache-2.0
// Makes the list of lights of each cluster, in the order of the lights and without a limit of its
// length. One invocation makes one list: it walks the list of the cluster's parent, or the light tree
// if the parent has no list, and writes the lights that it finds into pages of the entry buffer. Where
// a page lies depends on the schedule; which lights a list holds does not. A list that finds no page
// is marked as unlisted, and a list that is too long for a loop of the device is marked as long. The
// tiles of both are shaded without lists, with the same result (for long lists the last bit may
// differ, DECISIONS 12).
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/cluster_test.glsl"
#define LIGHT_STREAM_CORE CLUSTER_LISTS_CORE
#define LIGHT_STREAM_CORE_WORDS CLUSTER_LISTS_CORE_WORDS
#include "kernels/common/light_stream.glsl"
#define TREE_NODES CLUSTER_LISTS_NODES
#define TREE_NODE_WORDS CLUSTER_LISTS_NODE_WORDS
#include "kernels/common/light_tree.glsl"

layout(local_size_x = CLUSTER_LISTS_GROUP) in;
layout(push_constant, scalar) uniform Push
{
    ClusterListsParams params;
};
layout(scalar, binding = CLUSTER_LISTS_CLUSTERS) readonly buffer Clusters
{
    Cluster clusters[];
};
layout(scalar, binding = CLUSTER_LISTS_TILES) buffer Tiles
{
    TileClusters tiles[];
};
layout(scalar, binding = CLUSTER_LISTS_SPLITS) readonly buffer Splits
{
    WorkList splits;
};
layout(scalar, binding = CLUSTER_LISTS_LISTS) buffer Lists
{
    uint lists[];
};
layout(scalar, binding = CLUSTER_LISTS_ENTRIES) buffer Entries
{
    uint entries[];
};
layout(scalar, binding = CLUSTER_LISTS_COUNTERS) buffer Counters
{
    LightingCounters counters;
};

#include "kernels/common/count_lanes.glsl"
#include "kernels/common/cluster_of_lane.glsl"
#include "kernels/common/list_pages.glsl"

// The number of leaves that a lane finds before it tests their lights, so that the lanes walk the tree
// together and then test lights together.
const uint QUEUE = 16u;

// Appends the tile of a cluster that lights touch to the tiles that are shaded with lists or to those
// that are shaded without, and counts the cluster's list.
void appendTile(uint tile, ListWriter list, bool tooLong)
{
    const bool withoutList = tooLong || (list.full && list.found != 0u);
    if (withoutList)
        appendUnlisted(tile);
    else if (list.found != 0u)
        appendLit(tile);
    atomicAdd(counters.listEntries, withoutList ? 0u : list.found);
    atomicMax(counters.maxListLength, list.found);
}

void main()
{
    uint at;
    if (!takeCluster(at))
        return;
    const Cluster cluster = clusters[at];
    if (cluster.min.x > cluster.max.x)
        return;
    const ClusterBounds bounds = makeClusterBounds(cluster);
    const uint parent = params.hasParents != 0u ? lists[cluster.parent] : LIST_UNLISTED;
    const bool byParent = parent != LIST_UNLISTED && parent != LIST_LONG;

    // The list of a block is useless without a page, so the loops end. `expected` counts the lights
    // that the loops should have tested, because devices may end loops early without an error.
    const bool isBlock = params.which == LISTS_OF_BLOCKS;
    uint steps = 0u, expected = 0u;
    ListWriter list = beginList();
    uint from = byParent ? parent : NO_PAGE;
    while (from != NO_PAGE && steps < params.maxSteps && !(list.full && isBlock)) {
        const uint header = entries[from * PAGE_WORDS];
        const uint count = header & ((1u << PAGE_COUNT_BITS) - 1u);
        for (uint first = 0u; first < count; first += TREE_WIDTH) {
            makeRoom(list);
            const uint end = min(first + TREE_WIDTH, count);
            for (uint i = first; i < end; ++i)
                testLight(list, bounds, entries[from * PAGE_WORDS + 1u + i]);
        }
        COUNT_LISTS(count, 0u)
        expected += count;
        steps += count;
        from = header >> PAGE_COUNT_BITS;
    }
    bool cut = from != NO_PAGE || list.tested != expected;

    // A list without room is walked only to count the steps that shade_unlisted will need through the
    // tree.
    const bool measure = list.full && !isBlock && params.maxUnlistedSteps != 0xFFFFFFFFu;
    if (byParent && measure)
        steps = list.found = 0u;
    const uint lightEnd = params.tree.firstLight + params.tree.lightCount;
    const uint lastLeaf = (params.tree.lightCount - 1u) / TREE_WIDTH;
    // How many lights the last leaf lacks.
    const uint missing = (lastLeaf + 1u) * TREE_WIDTH - params.tree.lightCount;
    uint leaves[QUEUE];
    TreeWalk walk = beginTreeWalk(params.tree, TREE_LEVELS);
    walk.done = walk.done || (byParent && !measure);
    while (!walk.done && steps < params.maxSteps && !(list.full && isBlock)) {
        uint found = 0u;
        const uint stepsBefore = steps;
        while (!walk.done && found < QUEUE && steps < params.maxSteps) {
            const bool touched = boxTouches(bounds, treeNode(walk));
            if (touched && walk.level == 1u) {
                leaves[found] = walk.index;
                ++found;
            }
            if (touched && walk.level > 1u)
                descend(params.tree, walk);
            else
                skipSubtree(params.tree, walk);
            ++steps;
        }
        COUNT_LISTS(found * TREE_WIDTH, steps - stepsBefore)
        for (uint k = 0u; k < found; ++k) {
            makeRoom(list);
            const uint first = params.tree.firstLight + leaves[k] * TREE_WIDTH;
            for (uint i = first; i < min(first + TREE_WIDTH, lightEnd); ++i)
                testLight(list, bounds, i);
        }
        const bool atEnd = found != 0u && leaves[found - 1u] == lastLeaf;
        expected += found * TREE_WIDTH - (atEnd ? missing : 0u);
        steps += found * TREE_WIDTH;
    }
    cut = cut || !walk.done || list.tested != expected;
    const bool tooLong =
        cut || list.found > params.longest || (list.full && steps >= params.maxUnlistedSteps);
    lists[at] = endList(list, tooLong);
    if (!isBlock)
        appendTile(cluster.tile, list, tooLong);
}
