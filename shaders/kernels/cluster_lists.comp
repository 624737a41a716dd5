// SPDX-License-Identifier: Apache-2.0
// Makes the list of lights of each cluster, in the order of the lights. A list is found in the list
// of the cluster's parent, or in the light tree if the parent has no list, and written into pages of
// the entry buffer. No list is cut short: it is complete, or its cluster has none. On GPUs the lanes
// of a group make one list together, or several short ones. On llvmpipe each lane makes one by
// itself. All find the same lights. Where a page lies depends on the schedule; which lights a list
// holds does not, as long as there are pages for all.
//
// A list that finds no page is marked as unlisted, and a list that is too long as long. The lists of
// tiles and slices are too long if a loop of the device cannot walk them. Tiles of such clusters are
// shaded without lists, by the same lights; between the two pipelines the last bits may differ
// (DECISIONS 12 and 42). The lists of blocks are too long if testing their lights takes more than
// walking the tree (DECISIONS 70).
//
// A lane that makes the list of a tile by itself also finds the tile's height (shared/lighting_data.h,
// ANY_HEIGHT), unless the tile is split.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/cluster_test.glsl"
#define LIGHT_STREAM_CORE CLUSTER_LISTS_CORE
#define LIGHT_STREAM_CORE_WORDS CLUSTER_LISTS_CORE_WORDS
#include "kernels/common/light_stream.glsl"
#define TREE_NODES CLUSTER_LISTS_NODES
#define TREE_NODE_WORDS CLUSTER_LISTS_NODE_WORDS
#include "kernels/common/light_tree.glsl"

layout(local_size_x = CLUSTER_LISTS_GROUP, local_size_x_id = SPEC_LISTS_LANES) in;
layout(constant_id = SPEC_LISTS_LANES) const uint LANES = CLUSTER_LISTS_GROUP;
layout(constant_id = SPEC_LANES_TOGETHER) const bool lanesTogether = true;
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

#include "kernels/common/cluster_of_list.glsl"
#include "kernels/common/list_by_group.glsl"
#include "kernels/common/list_by_lane.glsl"
#include "kernels/common/lists_together.glsl"

// Appends the tile of a cluster that lights touch to the tiles that are shaded with lists or to
// those that are shaded without, and counts the cluster's list.
void appendTile(uint tile, ListWriter list, bool tooLong)
{
    const bool withoutList = tooLong || (list.full && list.found != 0u);
    if (withoutList)
        appendUnlisted(tile);
    else if (list.found != 0u)
        appendLit(tile, list.height);
    atomicAdd(counters.listEntries, withoutList ? 0u : list.found);
    atomicMax(counters.maxListLength, list.found);
}

// Completes the list of a cluster, which belongs to `tile` unless it is a block's.
void completeList(uint at, uint tile, ListWriter list, bool tooLong)
{
    lists[at] = endList(list, tooLong);
    if (params.which != LISTS_OF_BLOCKS)
        appendTile(tile, list, tooLong);
}

// Returns the list that a lane makes by itself. Consecutive lists of blocks and of split tiles are
// slices of one block or tile, whose lengths differ much, and the lanes of a vector wait for the
// longest. So consecutive lanes take the same slice of several blocks or tiles.
uint listOfLaneAlone(uint group, uint lane)
{
    const uint slices = params.which == LISTS_OF_BLOCKS   ? BLOCK_SLICES
                        : params.which == LISTS_OF_SLICES ? SLICES
                                                          : 1u;
    const uint neighbours = LANES / slices;
    return group * LANES + lane % neighbours * slices + lane / neighbours;
}

// Each lane makes a list.
void makeByLane(uint list)
{
    uint at;
    if (!clusterOfList(list, at))
        return;
    const Cluster cluster = clusters[at];
    if (cluster.min.x > cluster.max.x)
        return;
    const uint parent = params.which != LISTS_OF_BLOCKS ? lists[cluster.parent] : LIST_UNLISTED;
    ListWriter writer = beginList();
    if (params.findsHeights != 0u && params.which == LISTS_OF_TILES)
        writer.height = ALL_ABOVE; // until a lower light is found
    const bool tooLong =
        listOfLane(writer, makeClusterBounds(cluster), parent, params.which == LISTS_OF_BLOCKS);
    completeList(at, cluster.tile, writer, tooLong);
}

// The lanes of a group make a list that is not short, and the first group of a set makes the short
// lists of the set.
void makeByGroup(uint group)
{
    beginLanes();
    uint at, parent;
    if (clusterWithList(group, at, parent) && !isShortList(parent)) {
        ListWriter list = beginList();
        const bool tooLong = listOfGroup(list, makeClusterBounds(clusters[at]), parent,
                                         params.which == LISTS_OF_BLOCKS);
        if (lane == 0u)
            completeList(at, clusters[at].tile, list, tooLong);
    }
    if (group % LISTS_TOGETHER != 0u || params.which == LISTS_OF_BLOCKS)
        return;
    const uint shortLists = makeShortLists(group);
    if ((shortLists & (1u << lane)) != 0u) {
        const ListWriter list = shortList(lane);
        completeList(setCluster[lane], clusters[setCluster[lane]].tile, list,
                     list.found > params.longest);
    }
}

void main()
{
    const uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    if (lanesTogether)
        makeByGroup(group);
    else
        makeByLane(listOfLaneAlone(group, gl_LocalInvocationIndex));
}
