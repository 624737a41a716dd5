// SPDX-License-Identifier: Apache-2.0
// Makes the list of lights of each cluster, in the order of the lights. A list is found in the list
// of the cluster's parent, or in the light tree if the parent has no list, and written into pages of
// the entry buffer. No list is cut short: it is complete, or its cluster has none. The lanes of a group
// make one list together, or several short ones. Where a page lies depends on the schedule; which
// lights a list holds does not, as long as there are pages for all.
//
// A list that finds no page is marked as unlisted, and a list that is too long as long. The lists of
// tiles and slices are too long if a loop of the device cannot walk them. Tiles of such clusters are
// shaded without lists, by the same lights; between the two pipelines the last bits may differ
// (DECISIONS 12 and 42). The lists of blocks are too long if testing their lights takes more than
// walking the tree (DECISIONS 70).
#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernels/common/list_by_group.glsl"
#include "kernels/common/lists_together.glsl"

// The lanes of a group make a list that is not short, and the first group of a set makes the short
// lists of the set.
void main()
{
    const uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    beginLanes();
    uint at, parent;
    if (clusterWithList(group, at, parent) && !isShortList(parent)) {
        ListWriter list = beginList();
        const bool tooLong = listOfGroup(list, makeClusterBounds(clusters[at]), parent,
                                         params.which == LISTS_OF_BLOCKS);
        if (lane == 0u)
            completeList(at, clusters[at].tile, list, tooLong, ANY_HEIGHT);
    }
    if (group % LISTS_TOGETHER != 0u || params.which == LISTS_OF_BLOCKS)
        return;
    const uint shortLists = makeShortLists(group);
    if ((shortLists & (1u << lane)) != 0u) {
        const ListWriter list = shortList(lane);
        completeList(setCluster[lane], clusters[setCluster[lane]].tile, list, isTooLong(list),
                     ANY_HEIGHT);
    }
}
