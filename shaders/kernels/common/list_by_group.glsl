// SPDX-License-Identifier: Apache-2.0
// The lanes of a group make one list together. In each turn a lane tests up to TESTS_PER_LANE lights,
// which are LANES apart, and the group appends those that touch the cluster in their order.
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

// Tests the lights of a turn and appends those that touch the cluster. `exist` tells which of the
// lane's lights there are, and `two` whether some lane has a second one.
void testLights(inout ListWriter list, ClusterBounds bounds, uvec2 lights, bvec2 exist, bool two)
{
    const vec4 first = lightCentre(lights.x), second = lightCentre(lights.y);
    const vec2 reach2 = vec2(lightEmission(lights.x).w, lightEmission(lights.y).w);
    appendLights(list, lights.x, exist.x && lightTouches(bounds, first.xyz, first.w, reach2.x));
    if (two)
        appendLights(list, lights.y, exist.y && lightTouches(bounds, second.xyz, second.w, reach2.y));
}

// Finds lights in the list that begins with a page. Returns whether all have been tested.
bool searchPages(inout ListWriter list, ClusterBounds bounds, uint page, bool isBlock)
{
    uint first = 0u; // of the lights on this page that this turn tests
    while (page != NO_PAGE && !(isBlock && isUseless(list))) {
        const uint header = entries[page * PAGE_WORDS];
        const uvec2 onPage = first + lane + uvec2(0u, LANES);
        const bvec2 exist = lessThan(onPage, uvec2(lightsOfPage(header)));
        const uvec2 words = page * PAGE_WORDS + 1u + min(onPage, uvec2(PAGE_LIGHTS - 1u));
        const uvec2 found = uvec2(entries[words.x], entries[words.y]);
        testLights(list, bounds, mix(uvec2(params.tree.firstLight), found, exist), exist,
                   first + LANES < lightsOfPage(header));
        first += TESTS_PER_LANE * LANES;
        if (first >= lightsOfPage(header)) {
            page = pageAfter(header);
            first = 0u;
        }
    }
    return page == NO_PAGE;
}

// Tests the nodes of a turn and queues those that touch the cluster. `firstNode` is the first of their
// level; the other parameters are those of testLights.
void testNodes(inout TreeTurn t, ClusterBounds bounds, uint firstNode, uvec2 nodes, bvec2 exist,
               bool two)
{
    const Box first = treeBox(firstNode + nodes.x), second = treeBox(firstNode + nodes.y);
    enqueue(t, nodes.x, exist.x && boxTouches(bounds, first));
    if (two)
        enqueue(t, nodes.y, exist.y && boxTouches(bounds, second));
}

// Finds lights in the tree. Returns whether all have been tested. Adds to `steps` the nodes and lights
// that one lane would have had to test.
bool searchTree(inout ListWriter list, ClusterBounds bounds, bool isBlock, inout uint steps)
{
    TreeTurn t = firstTurn(params.tree);
    while (t.parents != 0u && !(isBlock && isUseless(list))) {
        const uint levelSize = treeLevelSize(params.tree, t.level - 1u);
        bvec2 exist;
        const uvec2 children = uvec2(childOfTurn(t, levelSize, lane, exist.x),
                                     childOfTurn(t, levelSize, lane + LANES, exist.y));
        const bool two = t.parents * TREE_WIDTH > LANES;
        if (t.level == 1u)
            testLights(list, bounds, params.tree.firstLight + children, exist, two);
        else
            testNodes(t, bounds, levelFirst[t.level - 2u], children, exist, two);
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
    return !complete || isTooLong(list) ||
           (!isBlock && list.full && steps >= params.maxUnlistedSteps);
}

#endif
