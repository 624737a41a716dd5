// SPDX-License-Identifier: Apache-2.0
// The list of one cluster while it is written into pages of the entry buffer, and its end.
#ifndef CND_COMMON_LIST_PAGES
#define CND_COMMON_LIST_PAGES

#include "kernels/common/cluster_of_list.glsl"
#include "kernels/common/page_header.glsl"

const uint NO_PAGE = 0u;

struct ListWriter {
    uint headPage, page; // first and last page, NO_PAGE before there is one
    uint inPage;         // lights on the last page
    uint found;          // lights
    bool full;           // the buffer had no page left: lights are still counted, but not written
};

// A list begins as if it had a complete page.
ListWriter beginList()
{
    return ListWriter(NO_PAGE, NO_PAGE, PAGE_LIGHTS, 0u, false);
}

// Takes a page of the entry buffer, or returns NO_PAGE if none is left. The cursor does not wrap,
// because a list that has asked in vain does not ask again. Page 0 is never given out, because 0 is
// NO_PAGE.
uint reservePage()
{
    const uint next = atomicAdd(counters.pageCursor, 1u) + 1u;
    return next < params.pageCount ? next : NO_PAGE;
}

// Tells whether the list of a block is of no use to the clusters in the block, because it is too long.
bool isUseless(ListWriter list)
{
    return list.found > params.longest;
}

// Completes the last page and returns the head of the list: its first page, or which kind of list
// without pages it is.
uint endList(ListWriter list, bool tooLong)
{
    if (list.page != NO_PAGE)
        entries[list.page * PAGE_WORDS] = pageHeader(list.inPage, NO_PAGE);
    return tooLong            ? LIST_LONG
           : list.found == 0u ? LIST_EMPTY
           : list.full        ? LIST_UNLISTED
                              : list.headPage;
}

// Appends the tile of a cluster that lights touch to the tiles that are shaded with lists or to
// those that are shaded without, and counts the cluster's list. `height`: that of the tile.
void appendTile(uint tile, ListWriter list, bool tooLong, uint height)
{
    const bool withoutList = tooLong || (list.full && list.found != 0u);
    if (withoutList)
        appendUnlisted(tile);
    else if (list.found != 0u)
        appendLit(tile, height);
    atomicAdd(counters.listEntries, withoutList ? 0u : list.found);
    atomicMax(counters.maxListLength, list.found);
}

// Counts the pages of a list that found too few. Pages may lack their last lights
// (kernels/cpu/cluster_lists.comp).
void countMissing(ListWriter list)
{
    const uint least = PAGE_LIGHTS - TREE_WIDTH + 1u;
    const uint pages = (list.found + least - 1u) / least;
    if (params.which == LISTS_OF_BLOCKS)
        atomicAdd(counters.missingBlockPages, pages);
    else
        atomicAdd(counters.missingPages, pages);
}

// Completes the list of a cluster, which belongs to `tile` unless it is a block's.
void completeList(uint at, uint tile, ListWriter list, bool tooLong, uint height)
{
    lists[at] = endList(list, tooLong);
    if (list.full && list.found <= params.longest)
        countMissing(list);
    if (params.which != LISTS_OF_BLOCKS)
        appendTile(tile, list, tooLong, height);
}

#endif
