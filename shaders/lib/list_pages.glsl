// SPDX-License-Identifier: Apache-2.0
// Writes the list of one cluster into pages of the entry buffer, one at a time. The includer provides
// entries[], counters and params.pageCount.
#ifndef CND_LIB_LIST_PAGES
#define CND_LIB_LIST_PAGES

#include "lib/cluster_test.glsl"

const uint NO_PAGE = 0u;

// The list that is being written.
uint headPage = NO_PAGE, page = NO_PAGE;
uint inPage = 0u; // lights of the page
uint tested = 0u, total = 0u; // lights tested, lights found
bool full = false; // there was no page left

// A list asks once more than there are pages at most, so the cursor does not wrap. Page 0 is none.
uint reservePage()
{
    const uint next = atomicAdd(counters.pageCursor, 1u) + 1u;
    return next < params.pageCount ? next : NO_PAGE;
}

// Makes room for the lights of a leaf.
void turnPage()
{
    const uint next = reservePage();
    if (page != NO_PAGE)
        entries[page * PAGE_WORDS] = next << PAGE_COUNT_BITS | inPage;
    else
        headPage = next;
    page = next;
    inPage = 0u;
    full = full || next == NO_PAGE;
}

void testLight(ClusterBounds bounds, uint light)
{
    ++tested;
    const vec4 centre = lightCentre(light);
    if (!lightTouches(bounds, centre.xyz, centre.w, lightEmission(light).w))
        return;
    if (!full) {
        ++inPage;
        entries[page * PAGE_WORDS + inPage] = light;
    }
    ++total;
}

// Room for TREE_WIDTH lights.
void makeRoom()
{
    if (!full && (page == NO_PAGE || inPage + TREE_WIDTH > PAGE_LIGHTS))
        turnPage();
}

#endif
