// SPDX-License-Identifier: Apache-2.0
// Writes the list of one cluster into pages of the entry buffer, one page at a time. The includer
// provides entries[], counters and params.pageCount.
#ifndef CND_COMMON_LIST_PAGES
#define CND_COMMON_LIST_PAGES

#include "lib/cluster_test.glsl"

const uint NO_PAGE = 0u;

// The list that a lane is writing.
struct ListWriter {
    uint headPage, page; // first and last page, NO_PAGE before there is one
    uint inPage;         // lights on the last page
    uint tested, found;  // lights
    bool full;           // the buffer had no page left: lights are still counted, but not written
};

ListWriter beginList()
{
    return ListWriter(NO_PAGE, NO_PAGE, 0u, 0u, 0u, false);
}

// Takes a page of the entry buffer, or returns NO_PAGE if none is left. The cursor does not wrap: a
// list asks at most once more than there are pages. Page 0 is never given out, because 0 is NO_PAGE.
uint reservePage()
{
    const uint next = atomicAdd(counters.pageCursor, 1u) + 1u;
    return next < params.pageCount ? next : NO_PAGE;
}

// Completes the last page, and begins the next one.
void turnPage(inout ListWriter list)
{
    const uint next = reservePage();
    if (list.page != NO_PAGE)
        entries[list.page * PAGE_WORDS] = next << PAGE_COUNT_BITS | list.inPage;
    else
        list.headPage = next;
    list.page = next;
    list.inPage = 0u;
    list.full = list.full || next == NO_PAGE;
}

// Makes room on the last page for the lights of a leaf, TREE_WIDTH of them.
void makeRoom(inout ListWriter list)
{
    if (!list.full && (list.page == NO_PAGE || list.inPage + TREE_WIDTH > PAGE_LIGHTS))
        turnPage(list);
}

// Adds the light to the list if it may add something to the cluster.
void testLight(inout ListWriter list, ClusterBounds bounds, uint light)
{
    ++list.tested;
    const vec4 centre = lightCentre(light);
    if (!lightTouches(bounds, centre.xyz, centre.w, lightEmission(light).w))
        return;
    if (!list.full) {
        ++list.inPage;
        entries[list.page * PAGE_WORDS + list.inPage] = light;
    }
    ++list.found;
}

// Completes the last page and returns the head of the list: its first page, or which kind of list
// without pages it is.
uint endList(ListWriter list, bool tooLong)
{
    if (list.page != NO_PAGE)
        entries[list.page * PAGE_WORDS] = list.inPage;
    return tooLong            ? LIST_LONG
           : list.found == 0u ? LIST_EMPTY
           : list.full        ? LIST_UNLISTED
                              : list.headPage;
}

#endif
