// SPDX-License-Identifier: Apache-2.0
// The form of cluster_lists for GPUs: the lanes of a group make one list together. Each lane tests one
// light at a time, and the group appends those that touch the cluster in their order. The includer
// provides bindings and params of cluster_lists, and COUNT_LISTS (count_lanes.glsl).
#ifndef CND_COMMON_LIST_BY_GROUP
#define CND_COMMON_LIST_BY_GROUP

#include "kernels/common/list_pages.glsl"
#include "kernels/common/tree_queues.glsl"
#include "lib/cluster_test.glsl"

// Begins a page after the last one, which is full.
void turnPageOfGroup(inout ListWriter list)
{
    uint next = NO_PAGE;
    if (lane == 0u)
        next = reservePage();
    next = fromLane0(next);
    if (list.page == NO_PAGE)
        list.headPage = next;
    else if (lane == 0u)
        entries[list.page * PAGE_WORDS] = pageHeader(PAGE_LIGHTS, next);
    list.page = next;
    list.full = next == NO_PAGE;
}

// Appends the lights of the lanes that are `touched`, in the order of the lanes.
void appendLights(inout ListWriter list, uint light, bool touched)
{
    const uint lanes = lanesThatSay(touched);
    const uint count = uint(bitCount(lanes)), end = list.inPage + count;
    const uint place = list.inPage + lanesBefore(lanes);
    list.found += count;
    if (list.full)
        return;
    uint page = list.page;
    list.inPage = end;
    if (end > PAGE_LIGHTS) {
        turnPageOfGroup(list);
        list.inPage = end - PAGE_LIGHTS;
    }
    const bool onLast = place >= PAGE_LIGHTS;
    page = onLast ? list.page : page;
    if (touched && page != NO_PAGE)
        entries[page * PAGE_WORDS + 1u + place - (onLast ? PAGE_LIGHTS : 0u)] = light;
}

// Tests the lane's light and appends those of the group.
void testLights(inout ListWriter list, ClusterBounds bounds, uint light, bool exists)
{
    COUNT_LISTS(exists ? 1u : 0u, 0u)
    const vec4 centre = lightCentre(light);
    const float r2 = lightEmission(light).w;
    appendLights(list, light, exists && lightTouches(bounds, centre.xyz, centre.w, r2));
}

// Finds lights in the list that begins with a page. Returns whether all have been tested.
bool searchPages(inout ListWriter list, ClusterBounds bounds, uint page, bool isBlock)
{
    uint first = 0u; // of the lights on this page that this turn tests
    while (page != NO_PAGE && !(isBlock && isUseless(list))) {
        const uint header = entries[page * PAGE_WORDS];
        const uint onPage = first + lane;
        const bool exists = onPage < pageCount(header);
        const uint entry = entries[page * PAGE_WORDS + 1u + min(onPage, PAGE_LIGHTS - 1u)];
        testLights(list, bounds, exists ? entry : params.tree.firstLight, exists);
        first += LANES;
        if (first >= pageCount(header)) {
            page = pageAfter(header);
            first = 0u;
        }
    }
    return page == NO_PAGE;
}

// Finds lights in the tree. Returns whether all have been tested. Adds to `steps` the nodes and lights
// that one lane would have had to test.
bool searchTree(inout ListWriter list, ClusterBounds bounds, bool isBlock, inout uint steps)
{
    TreeTurn t = firstTurn(params.tree);
    while (t.parents != 0u && !(isBlock && isUseless(list))) {
        const bool ofLights = t.level == 1u;
        bool exists;
        const uint child = childOfLane(t, treeLevelSize(params.tree, t.level - 1u), exists);
        if (ofLights) {
            testLights(list, bounds, params.tree.firstLight + child, exists);
        } else {
            COUNT_LISTS(0u, exists ? 1u : 0u)
            const Box box = treeBox(levelFirst[t.level - 2u] + child);
            enqueue(t, child, exists && boxTouches(bounds, box));
        }
        steps += t.parents * TREE_WIDTH;
        nextTurn(t);
    }
    return t.parents == 0u;
}

// Makes the list of a cluster from the list of its parent, or from the tree if that has none. Returns
// whether it is too long. No loop is inside another, and each leaves what is still to be done, so that
// it shows if the device has ended a loop early.
bool listOfGroup(inout ListWriter list, ClusterBounds bounds, uint parent, bool isBlock)
{
    const bool byParent = parent != LIST_UNLISTED && parent != LIST_LONG;
    bool complete = searchPages(list, bounds, byParent ? parent : NO_PAGE, isBlock);
    // A list without room is walked only to count the steps that shade_unlisted will need through the
    // tree.
    const bool measure = list.full && !isBlock && params.maxUnlistedSteps != 0xFFFFFFFFu;
    uint steps = 0u;
    if (!byParent || measure) {
        list.found = 0u;
        complete = complete && searchTree(list, bounds, isBlock, steps);
    }
    return !complete || list.found > params.longest ||
           (list.full && steps >= params.maxUnlistedSteps);
}

#endif
