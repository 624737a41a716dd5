// SPDX-License-Identifier: Apache-2.0
// Finds which points of a light's facet a receiver sees, from a list of the triangles that count
// (list_occluders). The includer defines occluderItem(), which reads an item, and what
// occluder_walk.glsl asks for.
#ifndef CND_SHADING_LISTED_OCCLUDERS
#define CND_SHADING_LISTED_OCCLUDERS

#include "shading/occluder_walk.glsl"

// Returns the points of the facet that no triangle of the `count` items from `first` on hides. The
// first item is an instance. All lanes of the group have the same items.
uvec2 listedPoints(OccluderQuery q, uint first, uint count, bool asks)
{
    OccluderWalk w = walkFromRoot();
    uint at = first, turns = 0u;
    uint item = occluderItem(at);
    bool walks = asks;
    do {
        const uint instance = item & ~ITEM_IS_INSTANCE;
        const OccluderInstance o = occluderInstance(instance);
        const Facet f = facetOf(q); // again for each instance, because it would occupy registers
        setFacet(w, f);
        const vec3 position = setInstance(w, q, instance, o);
        setSpace(w.space, f, facetVectors(f, o.localFromView), occluderNode(o.firstNode),
                 o.viewFromLocal, position);
        ++at;
        item = occluderItem(at);
        do {
            do {
                if (walks && !isEmpty(w.lit))
                    w.lit &= ~pointsHiddenBy(w, leafFirst(item), turns);
                item = withoutFirst(item);
            } while (leafCount(item) != 0u);
            ++at;
            if (at < first + count)
                item = occluderItem(at);
        } while (at < first + count && (item & ITEM_IS_INSTANCE) == 0u);
        walks = walks && !isEmpty(w.lit);
    } while (at < first + count && subgroupAny(walks));
    return w.lit;
}

#endif
