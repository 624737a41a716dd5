// SPDX-License-Identifier: Apache-2.0
// The first word of a page of a light list (shared/cluster_data.h).
#ifndef CND_COMMON_PAGE_HEADER
#define CND_COMMON_PAGE_HEADER

#include "shared/cluster_data.h"

uint pageHeader(uint lights, uint next)
{
    return next << PAGE_COUNT_BITS | lights;
}
// Returns the number of lights in the page.
uint lightsOfPage(uint header)
{
    return header & ((1u << PAGE_COUNT_BITS) - 1u);
}
// Returns the next page of the list. 0: there is none.
uint pageAfter(uint header)
{
    return header >> PAGE_COUNT_BITS;
}

#endif
