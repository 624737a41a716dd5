// SPDX-License-Identifier: Apache-2.0
// The integral of the specular lobe along the rim of a disc light (outline.glsl explains the terms),
// and the heights of the rim.
//
// The rim is divided into pieces, each of which is taken for an arc of a conic in the directions of w.
// There are DISC_PIECES of them at first. A piece is halved, down to an eighth of its length, while the
// directions of w turn too far in it or the conic leaves the rim too far.
#ifndef CND_LIB_OUTLINE_DISC_LOBE
#define CND_LIB_OUTLINE_DISC_LOBE

#include "lib/outline/disc_view.glsl"

const uint DISC_PIECES = 6u;
const vec2 DISC_STEP = vec2(0.50000000, 0.86602540); // cosine and sine of 360 degrees / DISC_PIECES
const uint DISC_PARTS = 8u;         // into which a piece may be divided, a power of two
const float DISC_PIECE_TURN = 0.6;  // least cosine of the angle by which w turns in a piece
const float DISC_PIECE_OFF = 0.002; // largest angle between w on the conic and on the rim
const uint DISC_HEIGHT_STEPS = 3u;  // of Newton's method

// The points that divide the rim for the specular lobe. They are equally far apart in the angle s of
// lens.glsl, in which the directions of w turn about evenly. It follows from phi in two steps. With
//   tan(phi / 2) = stretch tan(t / 2)
// the rim's nearest and farthest points pass the receiver equally fast, and s is that of t - tNext,
// where tNext is t at the point next to the mirror direction.
struct RimPoints {
    float stretch;
    vec2 next;   // (cos, sin) of tNext
    float width; // 0..1
};

float rimStretch(DiscView d)
{
    return sqrt((1.0 + d.e) / d.root);
}

// Returns (cos, sin) of phi from those of t; with 1 / stretch in place of stretch it is the inverse.
vec2 stretchedAngle(vec2 t, float stretch)
{
    const float s2 = stretch * stretch;
    // 1 + cos and 1 - cos, without cancellation. For large stretches a few digits of them matter.
    const float plus = t.x < 0.0 ? t.y * t.y / (1.0 - t.x) : 1.0 + t.x;
    const float minus = t.x > 0.0 ? t.y * t.y / (1.0 + t.x) : 1.0 - t.x;
    const float inv = 1.0 / max(plus + s2 * minus, 1e-12);
    return vec2(plus - s2 * minus, 2.0 * stretch * t.y) * inv;
}

// Returns a vector with half the angle of the unit vector a, -90..90 degrees.
vec2 halfTurn(vec2 a)
{
    const float side = a.y < 0.0 ? -1.0 : 1.0;
    return a.x >= 0.0 ? vec2(1.0 + a.x, a.y) : vec2(abs(a.y), side * (1.0 - a.x));
}

// Returns (cos, sin) of s from those of phi.
vec2 rimPassing(RimPoints r, vec2 phi)
{
    const vec2 t = stretchedAngle(phi, 1.0 / r.stretch);
    return passingAngle(r.width, halfTurn(complexProduct(t, vec2(r.next.x, -r.next.y))));
}

// Returns (cos, sin) of phi from those of s.
vec2 rimAngle(RimPoints r, vec2 s)
{
    return stretchedAngle(complexProduct(r.next, angleFromPassing(r.width, s)), r.stretch);
}

RimPoints makeRimPoints(Outline k, DiscView d)
{
    RimPoints r;
    r.stretch = rimStretch(d);
    // The mirror direction is lc - fromMirror. Where it meets the disc's plane, the direction from the
    // centre is `towards`; what cancels is left out.
    const vec3 fromMirror = vec3(k.wc.xy / k.invD, k.lc.z - k.v.y);
    const vec3 towards = dot(fromMirror, d.normal) * k.lc - dot(k.lc, d.normal) * fromMirror;
    const vec2 inPlane = vec2(dot(towards, d.u), dot(towards, d.v)) / d.radius;
    const vec2 next = dot(inPlane, inPlane) > MIN_LENGTH2 ? unitVector(inPlane) : vec2(1.0, 0.0);
    r.next = stretchedAngle(next, 1.0 / r.stretch);
    const vec3 offset = next.x * d.u + next.y * d.v;
    const PointDistance distance = distanceOf(k, offset);
    const vec3 dl = distance.inverse * (offset - distance.longer * k.lc);
    const vec3 l = k.lc + dl;
    // The derivative of l by t, which is dphi / dt times that by phi.
    const vec3 tangent = next.x * d.v - next.y * d.u;
    const float rate = (0.5 * (1.0 + next.x) * (r.stretch * r.stretch - 1.0) + 1.0) / r.stretch;
    const vec3 turn = (rate * distance.inverse) * (tangent - dot(tangent, l) * l);
    r.width = passingWidth(stretchedPoint(k, k.invD * stretched(k.alpha, dl)),
                           k.invD * stretched(k.alpha, turn));
    return r;
}

// A point of the rim.
struct RimPoint {
    vec2 angle; // (cos, sin) of phi
    vec3 offset;
    PointDistance distance;
    OutlinePoint o;
};

RimPoint rimPoint(Outline k, DiscView d, vec2 angle)
{
    RimPoint p;
    p.angle = angle;
    p.offset = angle.x * d.u + angle.y * d.v;
    p.distance = distanceOf(k, p.offset);
    p.o = pointInDirection(k, p.distance.inverse * (p.offset - p.distance.longer * k.lc));
    return p;
}

// The middle of the rim between two points, which follow each other and are less than a full turn
// apart.
struct RimMiddle {
    vec3 offset;
    float cosine; // of half the angle between the points
    float longer; // see rimControl
};

RimMiddle rimMiddle(Outline k, DiscView d, RimPoint a, RimPoint b)
{
    const float whole = a.angle.x * b.angle.y - a.angle.y * b.angle.x; // sine of the angle
    const float side = whole < 0.0 ? -1.0 : 1.0;
    const vec2 half1 = side * unitVector(vec2(1.0 + dot(a.angle, b.angle), whole));
    const vec2 angle = complexProduct(a.angle, half1);
    RimMiddle m;
    m.offset = angle.x * d.u + angle.y * d.v;
    m.cosine = half1.x;
    m.longer = (1.0 + m.cosine) * distanceOf(k, m.offset).longer -
        0.5 * (a.distance.longer + b.distance.longer);
    return m;
}

// Returns the control point of a piece of the rim. As a rational Bezier curve with weights, the rim P
// has the control points Pa, cos C + m and Pb, where cos is that of half the angle between a and b, C
// is the disc's centre, and m goes from there to the middle M of the rim between a and b. w is
// A (|P| v + P) / |P|. Where |P| is replaced by the parabola with the values at a, M and b, the
// directions of w are those of a conic whose middle control point is
//   A (((1 + cos) |PM| - (|Pa| + |Pb|) / 2) v + cos C + m).
// This is exact for a disc far away.
ArcControl rimControl(Outline k, RimPoint a, RimMiddle m, RimPoint b)
{
    const float norm = sqrt(a.distance.inverse * b.distance.inverse);
    const vec3 dl = norm * (m.offset + m.longer * vec3(k.v.x, 0.0, k.v.y));
    return ArcControl(k.invD * stretched(k.alpha, dl), norm * m.cosine * k.distance);
}

// Returns the square of the angle between w on the conic and on the rim, from the differences of the
// parabola and |P| at a quarter and at three quarters of the curve.
float squaredOff(Outline k, RimPoint a, RimMiddle m, RimPoint b)
{
    // 16 times the curve, and the parabola.
    const float weight = 10.0 + 6.0 * m.cosine;
    const vec3 both = weight * k.distance * k.lc + a.offset + b.offset + 6.0 * m.offset;
    const float value =
        weight * k.distance + a.distance.longer + b.distance.longer + 6.0 * m.longer;
    const vec3 first = both + 8.0 * a.offset, second = both + 8.0 * b.offset;
    const float valueFirst = value + 8.0 * a.distance.longer;
    const float valueSecond = value + 8.0 * b.distance.longer;
    const float offFirst = valueFirst - sqrt(length2(first));
    const float offSecond = valueSecond - sqrt(length2(second));
    const float off = max(abs(offFirst), abs(offSecond));
    const vec3 eye = stretched(k.alpha, vec3(k.v.x, 0.0, k.v.y));
    const vec3 w = 0.5 * ((valueFirst + valueSecond) * eye + stretched(k.alpha, first + second));
    return off * off * length2(eye) / max(length2(w), MIN_LENGTH2);
}

// Adds the whole rim of a disc that shading/classify_lights.glsl takes for easy. Its pieces are not
// halved, though those of a few of these discs leave the rim by up to 0.004.
void addSmallRim(inout Outline k, DiscView d)
{
    const RimPoints points = makeRimPoints(k, d);
    vec2 at = vec2(-1.0, 0.0);
    RimPoint a = rimPoint(k, d, rimAngle(points, at));
    uint piece = 0u;
    do {
        at = complexProduct(at, DISC_STEP);
        const RimPoint b = rimPoint(k, d, rimAngle(points, at));
        addPiece(k, a.o, b.o, rimControl(k, a, rimMiddle(k, d, a, b), b), 1.0);
        a = b;
        ++piece;
    } while (piece < DISC_PIECES);
}

// Adds the rim above the plane of k.tilt.
void addRim(inout Outline k, DiscView d, bool across)
{
    const RimPoints points = makeRimPoints(k, d);
    vec2 begin = vec2(-1.0, 0.0);
    vec2 first = rimAngle(points, begin), last = first;
    float turn = 2.0 * PI;
    if (across && !d.above) {
        first = d.from;
        last = d.to;
        begin = rimPassing(points, first);
        const vec2 end = rimPassing(points, last);
        // Rounding may give an angle close to 0 or to a full turn the wrong sign. d.turn tells them
        // apart: more than half the rim is never less than 0.001 in s, and less than half the rim never
        // more than a full turn minus 0.001.
        turn = atan(begin.x * end.y - begin.y * end.x, dot(begin, end));
        turn = max(turn + (turn < (d.turn > PI ? 0.001 : -0.001) ? 2.0 * PI : 0.0), 0.0);
    }
    RimPoint a = rimPoint(k, d, first);
    // Positions along the rim are counted in parts. A piece whose begin is a multiple of its length may
    // follow, so that the division does not depend on what came before.
    const uint parts = DISC_PIECES * DISC_PARTS;
    uint done = 0u, length = DISC_PARTS;
    do {
        const float angle = turn * (float(done + length) / float(parts));
        const vec2 to = rimAngle(points, complexProduct(begin, vec2(cos(angle), sin(angle))));
        const RimPoint b = rimPoint(k, d, done + length == parts ? last : to);
        const RimMiddle m = rimMiddle(k, d, a, b);
        const ArcControl control = rimControl(k, a, m, b);
        const bool isShort = turnOf(k, a.o, b.o, control) > DISC_PIECE_TURN &&
            squaredOff(k, a, m, b) < DISC_PIECE_OFF * DISC_PIECE_OFF;
        if (isShort || length == 1u) {
            addPiece(k, a.o, b.o, control, 1.0);
            a = b;
            done += length;
            length = min(done & (~done + 1u), DISC_PARTS); // the lowest bit of `done`
        } else {
            length /= 2u;
        }
    } while (done < parts);
}

// Returns N . L of the rim's point where it is highest (side 1) or lowest (side -1), by steps of
// Newton's method from the angle t = `at`. The rim is p0 + cos(t) p1 + sin(t) p2, times a length.
float rimHeight(vec3 p0, vec3 p1, vec3 p2, vec2 at, float side)
{
    vec2 angle = at;
    float value = 0.0;
    for (uint step = 0u; step <= DISC_HEIGHT_STEPS; ++step) {
        const vec3 p = p0 + angle.x * p1 + angle.y * p2, q = angle.x * p2 - angle.y * p1;
        const float inv2 = 1.0 / max(length2(p), MIN_LENGTH2);
        // r1, r2: first and second derivative of ln |p|. first, second: those of N . L, both times |p|.
        const float r1 = inv2 * dot(p, q);
        const float r2 = inv2 * (length2(q) + dot(p, p0 - p)) - 2.0 * r1 * r1;
        const float first = q.z - p.z * r1;
        const float second = p0.z - p.z - 2.0 * q.z * r1 + p.z * (r1 * r1 - r2);
        value = p.z * sqrt(inv2);
        const float turn = clamp(side * first / max(abs(second), MIN_LENGTH2), -0.7, 0.7);
        angle = complexProduct(angle, unitVector(vec2(1.0, turn)));
    }
    return value;
}

// Sets the range of N . L over the disc. If the receiver's normal does not pass through the disc, the
// highest point is on the rim, next to the normal, and the lowest one is always on the rim.
void setRimHeights(inout Outline k, DiscView d)
{
    const vec3 centre = k.distance * k.lc;
    const vec3 towards = vec3(0.0, 0.0, dot(centre, d.normal)) - d.normal.z * centre;
    const float reach = d.radius * d.normal.z;
    k.inside = reach > 0.0 && length2(towards) < reach * reach;
    const float stretch = rimStretch(d), s2 = stretch * stretch;
    const vec3 p0 = (1.0 + s2) * centre + (1.0 - s2) * d.u;
    const vec3 p1 = (1.0 - s2) * centre + (1.0 + s2) * d.u;
    const vec3 p2 = 2.0 * stretch * d.v;
    // The line along the normal meets the disc's plane at a multiple of p0 + x p1 + y p2, and (x, y)
    // points from within the rim to the rim's point nearest to there. `at` is (x, y) times a factor
    // that is negative if the line meets the plane below the receiver; the highest point is then on the
    // other side.
    const vec2 at = unitVector(vec2(cross(p2, p0).z, cross(p0, p1).z));
    k.high = rimHeight(p0, p1, p2, at, 1.0);
    k.low = rimHeight(p0, p1, p2, -at, -1.0);
}

#endif
