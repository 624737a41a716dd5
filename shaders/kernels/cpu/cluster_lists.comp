// SPDX-License-Identifier: Apache-2.0
// The form of cluster_lists for llvmpipe: each lane makes a list alone, the same one. It also
// finds the height of a tile (shared/lighting_data.h, ANY_HEIGHT).
#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernels/common/list_pages.glsl"
#include "lib/cluster_test.glsl"

layout(local_size_x = CLUSTER_LISTS_GROUP) in;

// The number of leaves that a lane finds before it tests their lights, so that the lanes walk the tree
// together and then test lights together.
const uint LEAVES = 16u;

// Makes room on the last page for the lights of a leaf, TREE_WIDTH of them. If they might not fit,
// completes the page and begins the next one.
void makeRoom(inout ListWriter list)
{
    if (list.full || list.inPage + TREE_WIDTH <= PAGE_LIGHTS)
        return;
    const uint next = reservePage();
    if (list.page != NO_PAGE)
        entries[list.page * PAGE_WORDS] = pageHeader(list.inPage, next);
    else
        list.headPage = next;
    list.page = next;
    list.inPage = 0u;
    list.full = next == NO_PAGE;
}

// The list that a lane makes.
struct LaneList {
    ListWriter list;
    ClusterBounds bounds; // of its cluster
    bool isBlock;         // the list is useless if it is too long, so the loops end
    uint height;          // height of the list's tile by the lights so far (shared/lighting_data.h)
    uint steps;           // through the parent's list or the tree
    // Lights that have been tested, and that the loops should have tested, because devices may end
    // loops early without an error.
    uint tested, expected;
};

// Tells whether the lane goes on to make the list.
bool goesOn(LaneList l)
{
    return l.steps < params.maxSteps && !(l.isBlock && isUseless(l.list));
}

// Adds the light to the list if it may add something to the cluster.
void testLight(inout LaneList l, uint light)
{
    ++l.tested;
    const vec4 centre = lightCentre(light);
    const float influence2 = lightEmission(light).w;
    if (!lightTouches(l.bounds, centre.xyz, centre.w, influence2))
        return;
    l.height = min(l.height, heightOfSphere(l.bounds, centre.xyz, centre.w, influence2));
    if (!l.list.full) {
        ++l.list.inPage;
        entries[l.list.page * PAGE_WORDS + l.list.inPage] = light;
    }
    ++l.list.found;
}

// Finds lights in the list that begins with a page. Returns whether that list has been cut.
bool searchPages(inout LaneList l, uint page)
{
    while (page != NO_PAGE && goesOn(l)) {
        const uint header = entries[page * PAGE_WORDS];
        const uint count = lightsOfPage(header);
        for (uint first = 0u; first < count; first += TREE_WIDTH) {
            makeRoom(l.list);
            const uint end = min(first + TREE_WIDTH, count);
            for (uint i = first; i < end; ++i)
                testLight(l, entries[page * PAGE_WORDS + 1u + i]);
        }
        l.expected += count;
        l.steps += count;
        page = pageAfter(header);
    }
    return page != NO_PAGE || l.tested != l.expected;
}

// Finds lights in the tree, unless `skips`. Returns whether the walk has been cut.
bool searchTree(inout LaneList l, bool skips)
{
    const uint lightEnd = params.tree.firstLight + params.tree.lightCount;
    const uint lastLeaf = (params.tree.lightCount - 1u) / TREE_WIDTH;
    // How many lights the last leaf lacks.
    const uint missing = (lastLeaf + 1u) * TREE_WIDTH - params.tree.lightCount;
    uint leaves[LEAVES];
    TreeWalk walk = beginTreeWalk(params.tree, TREE_LEVELS);
    walk.done = walk.done || skips;
    while (!walk.done && goesOn(l)) {
        uint found = 0u;
        while (!walk.done && found < LEAVES && l.steps < params.maxSteps) {
            const bool touched = boxTouches(l.bounds, treeNode(walk));
            if (touched && walk.level == 1u) {
                leaves[found] = walk.index;
                ++found;
            }
            if (touched && walk.level > 1u)
                descend(params.tree, walk);
            else
                skipSubtree(params.tree, walk);
            ++l.steps;
        }
        for (uint k = 0u; k < found; ++k) {
            makeRoom(l.list);
            const uint first = params.tree.firstLight + leaves[k] * TREE_WIDTH;
            for (uint i = first; i < min(first + TREE_WIDTH, lightEnd); ++i)
                testLight(l, i);
        }
        const bool atEnd = found != 0u && leaves[found - 1u] == lastLeaf;
        l.expected += found * TREE_WIDTH - (atEnd ? missing : 0u);
        l.steps += found * TREE_WIDTH;
    }
    return !walk.done || l.tested != l.expected;
}

// Makes the list of a cluster from the list of its parent, or from the tree if that has none. Returns
// whether it is too long.
bool makeList(inout LaneList l, uint parent)
{
    const bool byParent = parent != LIST_UNLISTED && parent != LIST_LONG;
    bool cut = searchPages(l, byParent ? parent : NO_PAGE);
    // A list without room is walked only to count the steps that shade_unlisted will need through the
    // tree.
    const bool measure = l.list.full && !l.isBlock && params.maxUnlistedSteps != 0xFFFFFFFFu;
    if (byParent && measure)
        l.steps = l.list.found = 0u;
    cut = searchTree(l, byParent && !measure) || cut;
    return cut || isTooLong(l.list) ||
           (!l.isBlock && l.list.full && l.steps >= params.maxUnlistedSteps);
}

// Returns the list that a lane makes. Consecutive lists of blocks and of split tiles are
// slices of one block or tile, whose lengths differ much, and the lanes of a vector wait for the
// longest. So consecutive lanes take the same slice of several blocks or tiles.
uint listOfLane(uint group, uint lane)
{
    const uint slices = params.which == LISTS_OF_BLOCKS   ? BLOCK_SLICES
                        : params.which == LISTS_OF_SLICES ? SLICES
                                                          : 1u;
    const uint neighbours = CLUSTER_LISTS_GROUP / slices;
    return group * CLUSTER_LISTS_GROUP + lane % neighbours * slices + lane / neighbours;
}

void main()
{
    const uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    uint at;
    if (!clusterOfList(listOfLane(group, gl_LocalInvocationIndex), at))
        return;
    const Cluster cluster = clusters[at];
    if (cluster.min.x > cluster.max.x)
        return;
    const uint parent = params.which != LISTS_OF_BLOCKS ? lists[cluster.parent] : LIST_UNLISTED;
    // Tiles that are split have no height.
    const bool findsHeight = params.findsHeights != 0u && params.which == LISTS_OF_TILES;
    LaneList l = LaneList(beginList(), makeClusterBounds(cluster), params.which == LISTS_OF_BLOCKS,
                          findsHeight ? ALL_ABOVE : ANY_HEIGHT, 0u, 0u, 0u);
    const bool tooLong = makeList(l, parent);
    completeList(at, cluster.tile, l.list, tooLong, l.height);
}
