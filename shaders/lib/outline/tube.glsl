// SPDX-License-Identifier: Apache-2.0
// The outline of a tube light (a capsule): along the lines where planes through the receiver touch the
// cylinder it has two arcs of great circles, and at each end an arc of the circle on which cones from
// the receiver touch the end's sphere.
#ifndef CND_LIB_OUTLINE_TUBE
#define CND_LIB_OUTLINE_TUBE

#include "lib/outline/shading.glsl"

// The arc of an end is divided into two, or into four if the cosine of half its angle is below this. An
// end seen from the side has half angles of pi / 2.
const float TUBE_ARC_COSINE = -0.32;

// The tube as the receiver sees it. Offsets are relative to the middle of its axis.
struct TubeView {
    vec3 along;         // unit vector of the axis
    vec3 across;        // unit vector across the axis and perpendicular to the line of sight
    float axisLength, height; // of half the axis; of the centre along the axis
    float h2, r2;       // squared distance of the axis' line; squared radius
    float sine2;        // r2 / h2
    float cosine;       // sqrt(1 - sine2)
    bool endOn;         // the receiver sees one end only
};

// `axis`: from the centre to one end of the segment. A receiver inside the tube sees a tube of smaller
// radius that almost reaches it, nearly a hemisphere towards the nearest point of the segment.
TubeView viewTube(vec3 centre, vec3 axis, float radius)
{
    TubeView k;
    const float axis2 = length2(axis);
    k.axisLength = sqrt(max(axis2, MIN_LENGTH2));
    k.along = axis2 > MIN_LENGTH2 ? axis / k.axisLength : vec3(0.0, 0.0, 1.0);
    k.height = dot(centre, k.along);
    // Close to the axis the difference is mostly rounding, which is not perpendicular to the axis.
    const vec3 aside = centre - k.height * k.along;
    const vec3 perpendicular = aside - dot(aside, k.along) * k.along;
    k.h2 = length2(perpendicular);
    // For a receiver on the line of the axis, any direction across the line will do.
    const bool beside = k.h2 > 1e-12 * length2(centre);
    k.across = beside ? cross(k.along, perpendicular) * inversesqrt(max(k.h2, MIN_LENGTH2))
                      : anyPerpendicular(k.along);
    const vec3 nearest = centre - clamp(k.height, -k.axisLength, k.axisLength) * k.along;
    k.r2 = min(radius * radius, 0.9998 * length2(nearest));
    k.endOn = k.h2 <= k.r2;
    k.sine2 = k.endOn ? 1.0 : k.r2 / k.h2;
    k.cosine = sqrt(max(1.0 - k.sine2, 0.0));
    return k;
}

// Returns the unit vector across the axis that points away from the receiver.
vec3 awayFromReceiver(TubeView k)
{
    return cross(k.across, k.along);
}

// Where the planes through the receiver touch the cylinder at one end: at the offsets tangent + side
// and tangent - side. The former is the end of the arc there, and the latter its begin.
struct TubeTangents {
    vec3 tangent, side;
};

// `outwards`: 1 for the end that the axis points to, -1 for the other one.
TubeTangents tubeTangents(TubeView k, float outwards)
{
    TubeTangents t;
    t.side = (-sqrt(k.r2) * k.cosine * outwards) * k.across;
    t.tangent = (outwards * k.axisLength) * k.along - (k.sine2 * sqrt(k.h2)) * awayFromReceiver(k);
    return t;
}

// One end: the points of the circle that its arc is part of are circle + cos(angle) outward +
// sin(angle) acrossLength across, and the arc reaches equally far to both sides of angle 0.
struct TubeEnd {
    vec3 circle, outward, across;
    float acrossLength;
    ArcCircle seen;
    vec2 half1; // cosine and sine of half the arc's angle
};

TubeEnd makeTubeEnd(Outline outline, TubeView k, float outwards)
{
    TubeEnd e;
    const vec3 offset = (outwards * k.axisLength) * k.along;
    const vec3 end = outline.distance * outline.lc + offset;
    const float d2 = max(length2(end), MIN_LENGTH2);
    const float invD = inversesqrt(d2);
    const float s2 = min(k.r2 / d2, 0.9999);
    const float r = sqrt(k.r2);
    const float kappa = sqrt(1.0 - s2);
    const float rho = r * kappa;
    const float forward = outwards * k.height + k.axisLength; // > 0 for the end farther away
    const vec3 axis = invD * end;
    e.seen = ArcCircle(axis, kappa, s2, differenceTo(outline, offset) - s2 / (1.0 + kappa) * axis);
    e.circle = offset - s2 * end;
    e.outward =
        (rho * invD) * (sqrt(k.h2) * outwards * k.along - forward * awayFromReceiver(k));
    e.across = k.across;
    e.acrossLength = -rho * outwards;
    const float invKappa = 1.0 / kappa;
    e.half1 = vec2(forward * invD * sqrt(k.sine2) * invKappa, k.cosine * invKappa);
    if (k.endOn)
        e.half1 = forward < 0.0 ? vec2(-1.0, 0.0) : vec2(1.0, 0.0);
    return e;
}

vec3 onTubeEnd(TubeEnd e, vec2 at)
{
    return e.circle + at.x * e.outward + (at.y * e.acrossLength) * e.across;
}

// The parts of an end's arc above the horizon, as up to two ranges of its angle. A range that ends at
// -limit or limit, where the arc does, is told from one that ends at the horizon by comparing them, so
// `limit` is computed only once.
struct TubeRanges {
    float limit; // half the arc's angle
    vec2 first, second;
    bool hasFirst, hasSecond;
};

TubeRanges rangesAbovePlane(Outline k, TubeEnd e)
{
    const float limit = atan(e.half1.y, e.half1.x);
    // The height of a point is base + rise cos(angle - top).
    const vec3 up = upOf(k);
    const float base = k.distance * dot(up, k.lc) + dot(up, e.circle);
    const float acrossZ = e.acrossLength * dot(up, e.across), outwardZ = dot(up, e.outward);
    const float rise = max(sqrt(outwardZ * outwardZ + acrossZ * acrossZ), MIN_LENGTH2);
    const float cosine = clamp(-base / rise, -1.0, 1.0);
    const float reach = atan(sqrt(max(1.0 - cosine * cosine, 0.0)), cosine);
    // SwiftShader returns 0 for atan(-0.0, x) with x < 0, where pi or -pi is right. So -0 is replaced
    // by 0.
    const float top = atan(acrossZ == 0.0 ? 0.0 : acrossZ, outwardZ);
    // The circle is above the plane from top - reach to top + reach. Of all turns of this range, two
    // can meet the arc.
    const float lower = top > 0.0 ? top - 2.0 * PI : top, upper = lower + 2.0 * PI;
    const vec2 a = vec2(max(-limit, lower - reach), min(limit, lower + reach));
    const vec2 b = vec2(max(-limit, upper - reach), min(limit, upper + reach));
    const bool hasA = a.y > a.x, hasB = b.y > b.x;
    const bool whole = cosine <= -1.0;
    return TubeRanges(limit, whole ? vec2(-limit, limit) : hasA ? a : b, b,
                      cosine < 1.0 && limit > 0.0 && (whole || hasA || hasB), !whole && hasA && hasB);
}

// Returns cosine and sine of an angle. Vulkan lets both be wrong by 2^-11. Their length is made 1, so
// that points stay on their circle.
vec2 directionOf(float angle)
{
    return unitVector(vec2(cos(angle), sin(angle)));
}

// Adds the arcs of an end within a range of its angle.
void addTubeArcs(inout Outline k, TubeEnd e, float limit, vec2 range)
{
    // The points that divide the whole arc, as in addTubeHalf, also divide the part of it above the
    // horizon, so that nothing jumps when the tube touches the horizon.
    const uint parts = e.half1.x < TUBE_ARC_COSINE ? 4u : 2u;
    float angle = range.x;
    OutlinePoint a = pointAt(k, onTubeEnd(e, directionOf(range.x)));
    if (range.x > -limit)
        enterAt(k, a.dl);
    uint part = 1u;
    do { // a lane that is done may run once more (lens.glsl)
        const float next = min((2.0 * float(part) / float(parts) - 1.0) * limit, range.y);
        if (next > angle && part <= parts) {
            const OutlinePoint b = pointAt(k, onTubeEnd(e, directionOf(next)));
            addArc(k, a, b, e.seen, true);
            a = b;
            angle = next;
        }
        ++part;
    } while (part <= parts);
    if (range.y < limit)
        leaveAt(k, a.dl);
}

// Adds one side and the end after it of a tube that is wholly above the horizon. `last` is the
// outline's last point.
void addTubeHalf(inout Outline k, TubeView t, float outwards, inout OutlinePoint last)
{
    const TubeTangents sides = tubeTangents(t, outwards);
    const TubeEnd e = makeTubeEnd(k, t, outwards);
    const bool divided = e.half1.x < TUBE_ARC_COSINE;
    // Cosine and sine of half the arc's angle or, if its halves are divided again, of a quarter of it.
    const float cosQuarter = sqrt(max(0.5 + 0.5 * e.half1.x, 0.0));
    const vec2 turn =
        divided ? vec2(cosQuarter, sqrt(max(1.0 - cosQuarter * cosQuarter, 0.0))) : e.half1;
    const uint arcs = divided ? 4u : e.half1.x < 1.0 ? 2u : 0u;
    vec2 at = vec2(e.half1.x, -e.half1.y);
    uint part = 0u;
    do { // a lane that is done may run once more (lens.glsl)
        const bool isSide = part == 0u;
        at = isSide ? at : complexProduct(at, turn);
        // The ends of the arc are computed as the ends of the sides are.
        const vec3 begin = sides.tangent - sides.side, end = sides.tangent + sides.side;
        const bool isOnCircle = t.endOn || (!isSide && part < arcs);
        const OutlinePoint next =
            pointAt(k, isOnCircle ? onTubeEnd(e, at) : isSide ? begin : end);
        ArcCircle circle = greatCircle(k, last, next);
        if (!isSide)
            circle = e.seen;
        if (part <= arcs) {
            if (!isSide || !t.endOn)
                addArc(k, last, next, circle, true);
            last = next;
        }
        ++part;
    } while (part <= arcs);
}

// Adds the visible part of one side and of the end after it.
void addClippedTubeHalf(inout Outline k, TubeView t, float outwards)
{
    if (!t.endOn) {
        const TubeTangents s = tubeTangents(t, outwards);
        const vec3 other = s.tangent - (2.0 * dot(s.tangent, t.along)) * t.along; // of the other end
        addClippedEdge(k, other - s.side, s.tangent - s.side);
    }
    const TubeEnd e = makeTubeEnd(k, t, outwards);
    const TubeRanges ranges = rangesAbovePlane(k, e);
    uint range = 0u;
    do { // twice in every lane, so no lane runs it once more (lens.glsl)
        if (range == 0u ? ranges.hasFirst : ranges.hasSecond)
            addTubeArcs(k, e, ranges.limit, range == 0u ? ranges.first : ranges.second);
        ++range;
    } while (range < 2u);
}

// Returns the outline of a tube. `toCentre`: from the receiver to the centre; `toEnd`: from there to
// one end of the tube's segment.
WalkedOutline tubeOutline(ConicPoint p, OutlineFrame f, vec3 toCentre, vec3 toEnd, float radius,
                          OutlineNeeds needs)
{
    const vec3 centre = toFrame(f, toCentre), given = toFrame(f, toEnd);
    const float wide = widened(p.alpha, centre, given, radius);
    // The projected area of a tube seen from the side is 4 r l + pi r^2. A shorter axis l keeps it
    // proportional to the radius r.
    const float longer2 = max(length2(given), MIN_LENGTH2);
    const vec3 axis = given - 0.25 * PI * (wide - radius) * inversesqrt(longer2) * given;
    const bool below = centre.z + abs(given.z) + radius <= 0.0;
    const TubeView t = viewTube(centre, axis, wide);
    const float stretched2 = length2(stretched(p.alpha, axis)) + t.r2;
    Outline k = beginOutline(p, f, toCentre, centre, stretched2, needs);
    OutlinePoint last;
    if (!needs.across) {
        const TubeTangents sides = tubeTangents(t, -1.0);
        last = pointAt(k, sides.tangent + sides.side);
    }
    bool walks = true;
    do {
        if (walks) { // a lane that is done may run once more (lens.glsl)
            uint end = 0u;
            do {
                const float outwards = end == 0u ? 1.0 : -1.0;
                if (needs.across)
                    addClippedTubeHalf(k, t, outwards);
                else
                    addTubeHalf(k, t, outwards, last);
                ++end;
            } while (end < 2u);
            walks = beginUpperBand(k);
        }
    } while (walks);
    // The half axis across the tube is the radius, and the one along it is half the length with both
    // ends.
    const vec3 longer = sqrt(t.axisLength * (t.axisLength + 2.0 * sqrt(t.r2))) * t.along;
    // The vector irradiance of a tube of any length is at most that of an endless one. Rounding
    // exceeds it if the receiver almost touches the axis of a thin tube.
    const float most = t.endOn ? 1.0 : sqrt(t.sine2);
    return WalkedOutline(k, extentOf(k, longer, vec3(0.0), t.r2), !below, most, radius / wide);
}

#endif
