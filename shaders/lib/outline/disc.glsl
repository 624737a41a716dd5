// SPDX-License-Identifier: Apache-2.0
// The outline of a disc light.
#ifndef CND_LIB_OUTLINE_DISC
#define CND_LIB_OUTLINE_DISC

#include "lib/outline/disc_lobe.glsl"
#include "lib/outline/rectangle.glsl"

// Returns the outline of a disc. `toCentre`: from the receiver to its centre; `facing`: unit vector in
// the direction that the disc faces.
WalkedOutline discOutline(ConicPoint p, OutlineFrame f, vec3 toCentre, vec3 facing, float radius,
                          bool twoSided, OutlineNeeds needs)
{
    const vec3 centre = toFrame(f, toCentre), normal = toFrame(f, facing);
    const vec3 towards = dot(normal, centre) < 0.0 ? normal : -normal;
    DiscView d = viewDisc(centre, towards, radius);
    const float stretched2 = length2(stretched(p.alpha, d.u)) + length2(stretched(p.alpha, d.v));
    Outline k = beginOutline(p, f, toCentre, centre, stretched2, needs);
    bool seen = seesFlatLight(centre, normal, radius, twoSided);
    if (needs.lobe)
        setRimHeights(k, d);
    const float lowest = k.low;
    bool walks = true;
    do {
        if (walks) { // a lane that is done may run once more (lens.glsl)
            if (needs.across)
                clipRim(d, k);
            if (d.above)
                k.low = lowest;
            seen = seen && (!d.below || hasLowerBand(k));
            if (needs.lobe) {
                if (needs.cuts)
                    addRim(k, d, needs.across);
                else
                    addSmallRim(k, d);
            }
            const vec3 first = d.from.x * d.u + d.from.y * d.v;
            const vec3 last = d.to.x * d.u + d.to.y * d.v;
            k.diffuse = discRim(k, d, first, last, needs.across);
            if (needs.across && !d.above) {
                enterAt(k, differenceTo(k, first));
                leaveAt(k, differenceTo(k, last));
            }
            walks = beginUpperBand(k);
        }
    } while (walks);
    return WalkedOutline(k, extentOf(k, d.u, d.v, 0.0), seen, 1.0, 1.0);
}

#endif
