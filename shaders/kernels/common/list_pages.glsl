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

// Tells whether the list has more lights than loops can walk.
bool isTooLong(ListWriter list)
{
    return list.found > (list.full ? params.longest : params.longestShared);
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

// Returns how many parts the list has if several groups share it. Pages may lack their last lights.
uint partsOf(ListWriter list)
{
    const uint least = PART_PAGES * LEAST_PAGE_LIGHTS;
    return (list.found + least - 1u) / least;
}

// Lets several groups share a complete list, if there is room, and returns its first page. `height`:
// that of the tile.
uint shareList(ListWriter list, uint tile, uint height)
{
    const uint parts = partsOf(list);
    const uint part = atomicAdd(counters.parts, parts);
    if (part + parts > params.mostParts)
        return list.headPage;
    const uint first = reservePage();
    if (first == NO_PAGE) {
        atomicAdd(counters.missingPages, 1u);
        return list.headPage;
    }
    const uint words = first * PAGE_WORDS;
    entries[words] = pageHeader(0u, list.headPage);
    entries[words + 1u] = tile;
    entries[words + 2u] = parts;
    entries[words + 3u] = appendParts(tile, height, PART_OF_LIST | first, parts);
    entries[words + 4u] = part / 2u * PAGE_WORDS; // a list has two parts at least
    entries[words + 5u] = (params.mostParts / 2u + part * SUM_PAGES) * PAGE_WORDS;
    return first;
}

// Counts the pages of a list that found too few.
void countMissing(ListWriter list)
{
    const uint pages = (list.found + LEAST_PAGE_LIGHTS - 1u) / LEAST_PAGE_LIGHTS;
    if (params.which == LISTS_OF_BLOCKS)
        atomicAdd(counters.missingBlockPages, pages);
    else
        atomicAdd(counters.missingPages, pages);
}

// Completes the list of a cluster, which belongs to `tile` unless it is a block's.
void completeList(uint at, uint tile, ListWriter list, bool tooLong, uint height)
{
    uint head = endList(list, tooLong);
    if (params.which != LISTS_OF_BLOCKS && list.found > SHARED_FROM && !tooLong && !list.full) {
        head = shareList(list, tile, height);
        if (head == list.headPage && list.found > params.longest) {
            tooLong = true;
            head = LIST_LONG;
        }
    }
    lists[at] = head;
    if (list.full && list.found <= params.longest)
        countMissing(list);
    if (params.which != LISTS_OF_BLOCKS)
        appendTile(tile, list, tooLong, height);
}

#endif
