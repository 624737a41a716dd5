// SPDX-License-Identifier: Apache-2.0
// The form of cluster_lists for devices whose lanes are a vector of a CPU: each lane makes a list by
// itself. The includer provides bindings and params of cluster_lists.
#ifndef CND_COMMON_LIST_BY_LANE
#define CND_COMMON_LIST_BY_LANE

#include "kernels/common/list_pages.glsl"
#include "lib/cluster_test.glsl"

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

// Adds the light to the list if it may add something to the cluster. Counts it in `tested`.
void testLight(inout ListWriter list, ClusterBounds bounds, uint light, inout uint tested)
{
    ++tested;
    const vec4 centre = lightCentre(light);
    const float influence2 = lightEmission(light).w;
    if (!lightTouches(bounds, centre.xyz, centre.w, influence2))
        return;
    list.height = min(list.height, heightOfSphere(bounds, centre.xyz, centre.w, influence2));
    if (!list.full) {
        ++list.inPage;
        entries[list.page * PAGE_WORDS + list.inPage] = light;
    }
    ++list.found;
}

// Makes the list of a cluster from the list of its parent, or from the tree if that has none. Returns
// whether it is too long.
bool listOfLane(inout ListWriter list, ClusterBounds bounds, uint parent, bool isBlock)
{
    const bool byParent = parent != LIST_UNLISTED && parent != LIST_LONG;
    // The list of a block is useless without a page or if it is too long, so the loops end.
    // `expected` counts the lights that the loops should have tested, because devices may end loops
    // early without an error.
    uint steps = 0u, tested = 0u, expected = 0u;
    uint from = byParent ? parent : NO_PAGE;
    while (from != NO_PAGE && steps < params.maxSteps && !(isBlock && isUseless(list))) {
        const uint header = entries[from * PAGE_WORDS];
        const uint count = pageCount(header);
        for (uint first = 0u; first < count; first += TREE_WIDTH) {
            makeRoom(list);
            const uint end = min(first + TREE_WIDTH, count);
            for (uint i = first; i < end; ++i)
                testLight(list, bounds, entries[from * PAGE_WORDS + 1u + i], tested);
        }
        expected += count;
        steps += count;
        from = pageAfter(header);
    }
    bool cut = from != NO_PAGE || tested != expected;

    // A list without room is walked only to count the steps that shade_unlisted will need through the
    // tree.
    const bool measure = list.full && !isBlock && params.maxUnlistedSteps != 0xFFFFFFFFu;
    if (byParent && measure)
        steps = list.found = 0u;
    const uint lightEnd = params.tree.firstLight + params.tree.lightCount;
    const uint lastLeaf = (params.tree.lightCount - 1u) / TREE_WIDTH;
    // The number of lights that the last leaf lacks.
    const uint missing = (lastLeaf + 1u) * TREE_WIDTH - params.tree.lightCount;
    uint leaves[LEAVES];
    TreeWalk walk = beginTreeWalk(params.tree, TREE_LEVELS);
    walk.done = walk.done || (byParent && !measure);
    while (!walk.done && steps < params.maxSteps && !(isBlock && isUseless(list))) {
        uint found = 0u;
        while (!walk.done && found < LEAVES && steps < params.maxSteps) {
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
        for (uint k = 0u; k < found; ++k) {
            makeRoom(list);
            const uint first = params.tree.firstLight + leaves[k] * TREE_WIDTH;
            for (uint i = first; i < min(first + TREE_WIDTH, lightEnd); ++i)
                testLight(list, bounds, i, tested);
        }
        const bool atEnd = found != 0u && leaves[found - 1u] == lastLeaf;
        expected += found * TREE_WIDTH - (atEnd ? missing : 0u);
        steps += found * TREE_WIDTH;
    }
    cut = cut || !walk.done || tested != expected;
    return cut || list.found > params.longest || (list.full && steps >= params.maxUnlistedSteps);
}

#endif
