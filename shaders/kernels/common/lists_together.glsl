// SPDX-License-Identifier: Apache-2.0
// Short lists. Most lists of tiles and of slices are found among fewer lights than a group has lanes,
// so a group per list would leave most lanes idle. Instead one group makes several of them at once.
//
// The lists of a dispatch are divided into sets of LISTS_TOGETHER consecutive ones, and each set
// has as many groups as lists. A list is short if the list of its parent has one page at most; then
// it has one page at most itself. The first group of a set makes all short lists of the set. Each
// group, the first one too, makes its own list alone if that is not short, and otherwise has
// nothing more to do. So no group makes several long lists one after the other.
//
// The group numbers the pairs of a short list and a light of its parent: first the pairs of the
// first list, in the order of the lights, then those of the next list. Each turn tests LANES
// consecutive pairs, one per lane, whichever lists they belong to.
#ifndef CND_COMMON_LISTS_TOGETHER
#define CND_COMMON_LISTS_TOGETHER

#include "kernels/common/lane_group.glsl"
#include "kernels/common/list_pages.glsl"
#include "lib/cluster_test.glsl"

// No more than the fewest lanes of a group, because a lane looks up each list of the set.
// listOfPair() is written for 8 lists.
const uint LISTS_TOGETHER = 8u;

// For each list of the set: setCluster is the index of its cluster, and setParent is the head of the
// list of the cluster's parent. Both are used for short lists only.
shared uint setCluster[LISTS_TOGETHER], setParent[LISTS_TOGETHER];
// For each list of the set: setPairs counts its pairs and is 0 if the list is not short. setPairsEnd
// is the number of its last pair plus 1.
shared uint setPairs[LISTS_TOGETHER], setPairsEnd[LISTS_TOGETHER];
// For each short list: setFoundBefore counts the lights that the short lists before it have found,
// setFound counts the lights that it has found itself, and setPage is the page that holds them.
shared uint setFoundBefore[LISTS_TOGETHER], setFound[LISTS_TOGETHER], setPage[LISTS_TOGETHER];

// Sets `at` to the cluster of a list, and `parent` to the head of its parent's list, which is
// LIST_UNLISTED if there are no parents. Returns false if there is no such list, or no sample in
// the cluster.
bool clusterWithList(uint list, out uint at, out uint parent)
{
    parent = LIST_UNLISTED;
    if (!clusterOfList(list, at) || clusters[at].min.x > clusters[at].max.x)
        return false;
    if (params.which != LISTS_OF_BLOCKS)
        parent = lists[clusters[at].parent];
    return true;
}

// Tells whether a list is short, by the head of its parent's list. There are no short lists on
// devices that limit loops, because a list without room may then need a walk of the whole group
// through the tree (list_by_group.glsl).
bool isShortList(uint parent)
{
    if (parent == LIST_UNLISTED || parent == LIST_LONG || params.maxUnlistedSteps != 0xFFFFFFFFu)
        return false;
    return parent == LIST_EMPTY || pageAfter(entries[parent * PAGE_WORDS]) == NO_PAGE;
}

// Looks up the lists of the set that begins with the list `first` of the dispatch. Returns a word
// with a bit for each short one.
uint lookUpSet(uint first)
{
    bool isShort = false;
    if (lane < LISTS_TOGETHER) {
        uint at, parent;
        isShort = clusterWithList(first + lane, at, parent) && isShortList(parent);
        setCluster[lane] = at;
        setParent[lane] = parent;
        setPairs[lane] =
            isShort && parent != LIST_EMPTY ? lightsOfPage(entries[parent * PAGE_WORDS]) : 0u;
        setFound[lane] = 0u;
        setPage[lane] = NO_PAGE;
    }
    const uint shortLists = lanesThatSay(isShort);
    syncLanes();
    return shortLists;
}

// Numbers the pairs of the short lists, and returns how many there are.
uint numberPairs()
{
    uint all = 0u, end = 0u;
    for (uint i = 0u; i < LISTS_TOGETHER; ++i) {
        all += setPairs[i];
        end = i == lane ? all : end;
    }
    if (lane < LISTS_TOGETHER)
        setPairsEnd[lane] = end;
    syncLanes();
    return all;
}

// Returns the list that a pair belongs to, which is the number of lists whose pairs end before it.
uint listOfPair(uint pair)
{
    uint list = pair >= setPairsEnd[3] ? 4u : 0u;
    list += pair >= setPairsEnd[list + 1u] ? 2u : 0u;
    return list + (pair >= setPairsEnd[list] ? 1u : 0u);
}

// Makes the short lists of the set that begins with the list `firstList` of the dispatch. Returns a
// word with a bit for each of them.
uint makeShortLists(uint firstList)
{
    const uint shortLists = lookUpSet(firstList);
    const uint pairs = numberPairs();
    uint found = 0u; // counts the lights that earlier turns have found for all lists together
    for (uint first = 0u; first < pairs; first += LANES) {
        const bool exists = first + lane < pairs;
        const uint pair = min(first + lane, pairs - 1u);
        const uint list = listOfPair(pair);
        const uint begin = setPairsEnd[list] - setPairs[list];
        const uint light = entries[setParent[list] * PAGE_WORDS + 1u + pair - begin];
        const ClusterBounds bounds = makeClusterBounds(clusters[setCluster[list]]);
        const vec4 centre = lightCentre(light);
        const bool touched =
            exists && lightTouches(bounds, centre.xyz, centre.w, lightEmission(light).w);

        const uint lanes = lanesThatSay(touched);
        // If the list begins in this turn, the lights before its own are those of earlier turns and
        // of the lanes before its first pair.
        const uint foundBefore =
            begin < first ? setFoundBefore[list]
                          : found + uint(bitCount(lanes & ((1u << (begin - first)) - 1u)));
        const uint place = found + lanesBefore(lanes) - foundBefore;
        if (exists && pair == begin)
            setFoundBefore[list] = foundBefore;
        if (exists && pair + 1u == setPairsEnd[list])
            setFound[list] = place + (touched ? 1u : 0u);
        if (touched && place == 0u)
            setPage[list] = reservePage();
        syncLanes();
        if (touched && setPage[list] != NO_PAGE)
            entries[setPage[list] * PAGE_WORDS + 1u + place] = light;
        found += uint(bitCount(lanes));
    }
    return shortLists;
}

// Returns a short list that is complete except for its header.
ListWriter shortList(uint list)
{
    const uint page = setPage[list], found = setFound[list];
    return ListWriter(page, page, found, found, found != 0u && page == NO_PAGE);
}

#endif
