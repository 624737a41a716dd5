// SPDX-License-Identifier: Apache-2.0
// The outline of a tube light (a capsule) as a polygon, and its form factor.
#ifndef CND_BENCH_LTC_TUBE
#define CND_BENCH_LTC_TUBE

#include "bench/ltc/contour.glsl"

// How many edges replace the arc of each end. The outline's two long edges are exact.
const int TUBE_ARC_EDGES = 6;

// The outline of a capsule as a receiver sees it. It has two long edges, along the lines where planes
// through the receiver touch the cylinder, and at each end an arc of the circle where cones from the
// receiver touch the end's sphere. Positions are relative to the receiver; offsets are relative to the
// middle of the axis.
struct TubeOutline {
    vec3 centre, axis;
    float radius;
    vec3 across;            // unit vector across the plane of the receiver and the axis
    float side;             // half the chord between the two lines, which is along `across`
    vec3 tangent[2];        // offset of the middle of that chord at each end
    vec3 circle[2];         // offset of the centre of each end's circle
    vec3 outward[2];        // radius of that circle away from the other end, in the plane of the axis
    float circleRadius[2];  // radius of that circle, which has a radius along `across`
    float halfAngle[2];     // half angle of that circle's arc, 0..pi
};

// `axis`: from the centre to one end of the segment. A receiver inside the tube sees a tube of smaller
// radius that almost reaches it, nearly a hemisphere towards the nearest point of the segment.
TubeOutline makeTubeOutline(vec3 toCentre, vec3 axis, float radius)
{
    TubeOutline k;
    k.centre = toCentre;
    k.axis = axis;
    k.radius = radius;
    const float axisLength = sqrt(max(length2(axis), MIN_LENGTH2));
    const vec3 along = length2(axis) > MIN_LENGTH2 ? axis / axisLength : vec3(0.0, 0.0, 1.0);
    const float height = dot(toCentre, along);
    const vec3 perpendicular = toCentre - height * along;
    const float h2 = length2(perpendicular);
    // For a receiver on the line of the axis, any direction across the line will do.
    const bool beside = h2 > 1e-12 * length2(toCentre);
    const float invH = beside ? inversesqrt(h2) : 0.0;
    k.across = beside ? cross(along, perpendicular) * invH : anyPerpendicular(along);
    const vec3 away = cross(k.across, along); // from the receiver to the axis
    const vec3 nearest = toCentre - clamp(height, -axisLength, axisLength) * along;
    const float r2 = min(radius * radius, 0.9998 * length2(nearest));
    const float r = sqrt(r2);

    // A receiver beyond an end, and closer to the axis' line than the radius, sees the near end only.
    const bool endOn = h2 <= r2;
    const float sine2 = endOn ? 1.0 : r2 * invH * invH;
    const float cosine = sqrt(max(1.0 - sine2, 0.0));
    k.side = r * cosine;
    for (int i = 0; i < 2; ++i) {
        const float outwards = i == 0 ? 1.0 : -1.0;
        const vec3 end = toCentre + outwards * axis;
        const float d2 = max(length2(end), MIN_LENGTH2);
        const float invD = inversesqrt(d2);
        const float s2 = min(r2 / d2, 0.9999);
        const float rho = r * sqrt(1.0 - s2);
        const float forward = outwards * (height + outwards * axisLength); // > 0 for the far end
        k.circle[i] = outwards * axis - s2 * end;
        // Perpendicular to `end` in the plane of the axis, away from the other end.
        const float h = sqrt(h2);
        k.outward[i] = rho * invD * outwards * (h * along - (height + outwards * axisLength) * away);
        k.circleRadius[i] = rho;
        k.tangent[i] = outwards * axis - sine2 * perpendicular;
        const float sinArc = cosine * inversesqrt(1.0 - s2);
        k.halfAngle[i] = atan(sinArc, forward * invD * r * invH * inversesqrt(1.0 - s2));
        if (endOn) {
            const bool near = forward < 0.0;
            k.halfAngle[i] = near ? PI : 0.0;
        }
    }
    if (endOn) {
        // All edges of the far end shrink to the point where the near end's arc begins.
        const bool firstIsNear = height < 0.0;
        const vec3 start = firstIsNear ? k.circle[0] - k.outward[0] : k.circle[1] - k.outward[1];
        k.tangent[0] = start;
        k.tangent[1] = start;
        const int far = firstIsNear ? 1 : 0;
        k.circle[far] = start;
        k.outward[far] = vec3(0.0);
        k.circleRadius[far] = 0.0;
    }
    return k;
}

// Returns the form factor of the outline after a linear map, for a receiver with normal n in the mapped
// space. The first and the last edge of an arc are tangents of the circle at the ends of the arc, and
// the edges enclose the same area as the arc.
float tubeOutlineFormFactor(vec3 n, mat3 map, TubeOutline tube)
{
    const float offset2 = length2(map * (0.5 * (tube.tangent[0] - tube.tangent[1]))) +
                          length2(map * (tube.side * tube.across));
    Contour k = beginContour(n, map * tube.centre, offset2);
    for (int i = 0; i < 2; ++i) {
        // i = 0 goes along the axis and from +side to -side, i = 1 goes back.
        const float turn = i == 0 ? 1.0 : -1.0;
        const vec3 tangent = tube.tangent[i], before = tube.tangent[1 - i];
        const vec3 side = map * (turn * tube.side * tube.across);
        contourEdge(k, map * (0.5 * (tangent + before)) + side, map * (0.5 * (tangent - before)));
        vec3 last = map * tangent + side;
        const vec3 circle = map * tube.circle[i];
        const vec3 outward = map * tube.outward[i];
        const vec3 across = map * (turn * tube.circleRadius[i] * tube.across);
        const float edges = float(TUBE_ARC_EDGES);
        const float delta = max(2.0 * tube.halfAngle[i] / edges, 1e-3);
        const float half1 = sin(0.5 * delta);
        const float inner = (edges - 1.0) * sin(delta);
        const float scale = (sqrt(half1 * half1 + inner * edges * delta) - half1) / inner;
        for (int j = 0; j < TUBE_ARC_EDGES; ++j) {
            const float angle = tube.halfAngle[i] * (1.0 - (2.0 * float(j) + 1.0) / edges);
            const vec3 next = circle + scale * (cos(angle) * outward + sin(angle) * across);
            contourEdge(k, 0.5 * (last + next), 0.5 * (next - last));
            last = next;
        }
        const vec3 to = map * tangent - side;
        contourEdge(k, 0.5 * (last + to), 0.5 * (to - last));
    }
    return contourFormFactor(k);
}

// Tells whether the whole tube is below the horizon. Corners of the polygon that replaces its outline
// may then still be slightly above it.
bool tubeIsBelow(vec3 n, TubeOutline tube)
{
    return dot(n, tube.centre) + abs(dot(n, tube.axis)) + tube.radius <= 0.0;
}

// Returns the form factor F = E / (pi L), 0..1. The largest error measured is 3.1e-3 of F or of the
// form factor of the same tube seen from the side, whichever is larger; the mean error is 5e-6.
float tubeFormFactor(vec3 n, TubeOutline tube)
{
    if (tubeIsBelow(n, tube))
        return 0.0;
    return tubeOutlineFormFactor(n, mat3(1.0), tube);
}

#endif
