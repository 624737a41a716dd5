// SPDX-License-Identifier: Apache-2.0
// The outline of a rectangle light, and of every other flat light with straight edges.
#ifndef CND_LIB_OUTLINE_RECTANGLE
#define CND_LIB_OUTLINE_RECTANGLE

#include "lib/outline/shading.glsl"

// Tells whether a receiver sees an emitting side of a flat light around `centre`, relative to the
// receiver. The light faces `normal`, of any length. Receivers that float32 cannot distinguish from
// points in the light's plane see none. `size`: length of the light's longest half axis.
bool seesFlatLight(vec3 centre, vec3 normal, float size, bool twoSided)
{
    const float facing = dot(normal, centre);
    const float limit = 1e-6 * sqrt(length2(normal) * max(length2(centre), size * size));
    return twoSided ? abs(facing) > limit : facing < -limit;
}

// Adds the edge to the next corner of a flat light. `from`, `to`: offsets of both corners, where `from`
// is only used if the light may cross the horizon; `last`: the point of the first corner, only used if
// it may not. The one that is used moves to the next corner.
void addEdgeTo(inout Outline k, inout vec3 from, inout OutlinePoint last, vec3 to)
{
    if (k.needs.across) {
        addClippedEdge(k, from, to);
        from = to;
    } else {
        const OutlinePoint next = pointAt(k, to);
        addEdge(k, last, next);
        last = next;
    }
}

// Returns the outline of a rectangle that faces axisU x axisV. `toCentre`: from the receiver to the
// centre; axisU and axisV go from there to the middles of two edges.
WalkedOutline rectangleOutline(ConicPoint p, OutlineFrame f, vec3 toCentre, vec3 axisU, vec3 axisV,
                               bool twoSided, OutlineNeeds needs)
{
    const vec3 centre = toFrame(f, toCentre);
    vec3 u = toFrame(f, axisU), v = toFrame(f, axisV);
    const bool below = centre.z + abs(u.z) + abs(v.z) <= 0.0; // before it is widened
    const bool uIsLonger = length2(u) >= length2(v);
    const float wider = widening(p.alpha, centre, uIsLonger ? u : v, uIsLonger ? v : u);
    u *= uIsLonger ? 1.0 : wider;
    v *= uIsLonger ? wider : 1.0;
    const vec3 normal = cross(u, v);
    // The corners are counterclockwise for a receiver that sees the front.
    const vec3 w = dot(normal, centre) < 0.0 ? v : -v;
    const float size2 = max(length2(u), length2(v));
    const float stretched2 = length2(stretched(p.alpha, u)) + length2(stretched(p.alpha, v));
    Outline k = beginOutline(p, f, toCentre, centre, stretched2, needs);
    const bool seen = seesFlatLight(centre, normal, sqrt(size2), twoSided) && !below;
    vec2 corner = vec2(-1.0, -1.0);
    vec3 from = -u - w;
    OutlinePoint last;
    if (!needs.across)
        last = pointAt(k, from);
    bool walks = true;
    do {
        if (walks) { // a lane that is done may run once more (lens.glsl)
            uint edge = 0u;
            do {
                corner = vec2(corner.y, -corner.x);
                addEdgeTo(k, from, last, corner.x * u + corner.y * w);
                ++edge;
            } while (edge < 4u);
            walks = beginUpperBand(k);
        }
    } while (walks);
    return WalkedOutline(k, extentOf(k, u, w, 0.0), seen, 1.0, 1.0 / wider);
}

#endif
