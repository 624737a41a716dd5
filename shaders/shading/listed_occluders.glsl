// SPDX-License-Identifier: Apache-2.0
// Finds which points of a light's facet a receiver sees, from a list of the triangles that count
// (list_occluders). The includer defines occluderItem(), which reads an item, and what
// occluder_walk.glsl asks for.
#ifndef CND_SHADING_LISTED_OCCLUDERS
#define CND_SHADING_LISTED_OCCLUDERS

#include "shading/occluder_walk.glsl"

// Returns what visiblePoints() does, for the `count` items from `first` on, at least one. All lanes
// of the group have the same items.
uvec2 listedPoints(OccluderQuery q, TreeSpace tree, uint first, uint count, bool asks)
{
    OccluderWalk w = walkFromRoot();
    uint at = first, turns = 0u;
    OccluderItem item = occluderItem(at);
    bool walks = asks;
    do {
        const uint instance = item.instance;
        w.leaf = (instance << OCCLUDER_LEAF_SHIFT) + 1u;
        changeTree(w, q, tree, walks);
        do {
            do {
                if (w.walks && !isEmpty(w.lit))
                    w.lit &= ~pointsHiddenBy(w, leafFirst(item.triangles), turns);
                item.triangles = withoutFirst(item.triangles);
            } while (leafCount(item.triangles) != 0u);
            ++at;
            if (at < first + count)
                item = occluderItem(at);
        } while (at < first + count && item.instance == instance);
        walks = walks && !isEmpty(w.lit);
    } while (at < first + count && subgroupAny(walks));
    return w.lit;
}

#endif
