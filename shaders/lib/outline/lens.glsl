// SPDX-License-Identifier: Apache-2.0
// The integral of the specular lobe along an arc of an emitter's outline (outline.glsl explains the
// terms).
//
// A circle arc of directions l is an arc of an ellipse in w = A (v + l), so the directions of w follow
// an arc of a conic. Its integral is the one along the great circle between its ends (Lambert's edge)
// plus the area between the two, the lens, which is computed to third order in its height. As a
// rational Bezier curve the conic has the control points w0, W1 and w1 with
//   W1 = (w0 + w1 - 2 sin^2 A (v + kappa c)) / (2 cos),
// where sin and cos are those of half the arc, c is the circle's axis and kappa the cosine of its half
// angle. W1 gives the tangents at the ends and thereby the height of the lens, and the curve's weight
// gives the ratio of its area to that of a parabola (segmentShare). The area is exact for a light so
// small that the lobe is constant over it.
//
// Let e be the tangent of the lens' elevation above the middle of the chord, and e f the one above its
// other points; f falls off like a parabola. The directions of a thin strip of the lens, from the chord
// up to the elevation psi = atan(e f), add (psi + sin psi cos psi) / 2 along the chord's direction and
// sin^2 psi / 2 across it. In powers of e the integrals along the chord are
//   (integral of f) e (1 - 16/35 e^2)   and   (integral of f^2) e^2 / 2 (1 - 16/21 e^2),
// where 1 - x is replaced by 1 / (1 + x), which stays positive.
//
// The formula is good while the lens is not high. Arcs that are long as the lobe sees them are cut into
// two or three pieces, near the lobe's middle.

#ifndef CND_LIB_OUTLINE_LENS
#define CND_LIB_OUTLINE_LENS

#include "lib/outline/points.glsl"

// Arcs between whose ends the cosine in the space of w is above the first limit are not cut; below the
// second limit they are cut twice. Nothing jumps: below the first limit the sums of the whole arc and
// of its halves are blended, and at the second one the middle piece grows from nothing. The result
// does not depend on the direction in which the arc is walked, so that the sides of a very thin light
// cancel.
const float CUT_ONCE = 0.7, CUT_TWICE = 0.2;
const float CUT_ONCE_RANGE = 0.1, CUT_TWICE_RANGE = 0.2; // blended or growing over this range

// Adds an arc, or a piece of one, times a weight.
void addPiece(inout Outline k, OutlinePoint a, OutlinePoint b, ArcCircle circle, float weight)
{
    const HalfAngle t = halfAngleOf(length2(b.dl - a.dl), circle.s2);
    // v . axis + kappa, and A (v + kappa axis). For small circles both may cancel, so they are computed
    // from the circle's centre.
    const bool great = circle.kappa == 0.0;
    const vec3 vPlusLc = vec3(k.wc.xy, k.wc.z / k.alpha) / k.invD;
    const float fromCentre = 0.5 * length2(vPlusLc) + k.v.x * circle.centre.x +
        k.v.y * circle.centre.z - circle.s2;
    const float level = great ? k.v.x * circle.axis.x + k.v.y * circle.axis.z
                              : fromCentre / circle.kappa;
    const vec3 eye = vec3(k.v.x, 0.0, k.alpha * k.v.y);
    const vec3 pole =
        great ? k.invD * eye : k.wc + k.invD * stretched(k.alpha, circle.centre);
    // The determinant of (v + l0, V1, v + l1), where V1 is W1 without A.
    const float volume = 2.0 * circle.s2 * t.sin2 * sqrt(t.sin2) * level;
    const vec3 dwA = stretchedOffset(k, a), dwB = stretchedOffset(k, b);
    const vec3 pA = stretchedDirection(k, a), pB = stretchedDirection(k, b);
    const vec3 sum = pA + pB;
    const float q2 = max(0.25 * length2(sum), 1e-8); // squared cosine of half the chord's angle
    const float q = sqrt(q2);
    const float invQ2 = 1.0 / q2;
    const float H = segmentShare(q) / q;
    const vec3 area = cross(dwA, dwB);
    const vec3 axb = cross(k.wc, dwB - dwA) + area;
    const float ii = a.i * b.i;
    const float root = sqrt(ii);
    // Squared sine of half the chord's angle. The difference of pA and pB would have no digits if the
    // light is small.
    const float quarter = 0.25 * min(length2(ii * axb) * invQ2, 4.0);
    const float longer = a.e + b.e + a.e * b.e; // |w0|^2 |w1|^2 - 1
    const float perSine1 = quarter / (1.0 + q) * H; // angle / sine of the chord, minus 1
    const float excess = perSine1 * ii - longer * ii * ii / (1.0 + ii);

    const float lengths = (1.0 + a.e) * a.i + (1.0 + b.e) * b.i; // |w0| + |w1|
    const float weight2 = root / t.cosine * (lengths * q2 - t.sin2 * dot(pole, sum)); // times 2 q2
    const float height = k.alpha * k.invD * k.invD * k.invD * volume * root * ii;
    // The second limit keeps the lens below 45 degrees. It is reached only by arcs far from the lobe.
    const float invQuarter = 1.0 / max(quarter, 1e-20);
    const float scale = max(2.0 * q2 + weight2, abs(height) * sqrt(invQuarter) + 1e-12);
    const float share = 0.75 * segmentShare(clamp(0.5 * weight2 * invQ2, 0.0, 1.5));
    const float eSine = height / scale; // e times the sine of half the chord's angle
    const float e2 = eSine * eSine * invQuarter;
    const float along = share * H * eSine / (1.0 + (16.0 / 35.0) * e2);
    const float across = share * (8.0 / 15.0) * e2 * ii * (1.0 + perSine1) / (1.0 + (16.0 / 21.0) * e2);
    k.specular += weight * (area + (excess - across) * axb + along * sum);
}

float growth(float x)
{
    const float t = saturate(x);
    return t * t * (3.0 - 2.0 * t);
}

vec2 unitVector(vec2 a)
{
    return a * inversesqrt(max(dot(a, a), MIN_LENGTH2));
}

// How an arc is cut. A point of the arc is at the angle t from its point next to the mirror direction,
// where the lobe has the half width `width` in tan(t / 2). The cuts are at equal distances in x =
// asinh(tan(t / 2) / width) / 4, so that lobes of any width get the same number of pieces; begin and
// end are tanh(x) at the ends of the arc.
struct ArcCuts {
    vec2 next; // cosine and sine of the angle from the arc's begin to the point next to the mirror
    float width;
    float begin, end;
};

// Returns tanh(asinh(y) / 4).
float quarterAsinh(float y)
{
    const float half1 = y / (1.0 + sqrt(1.0 + y * y));
    return half1 / (1.0 + sqrt(max(1.0 - half1 * half1, 0.0)));
}

// Returns the vector from the centre of an arc's circle to the point at an angle from its begin, given
// by cosine and sine.
vec3 onCircle(OutlinePoint a, ArcCircle circle, vec2 angle)
{
    const vec3 X = a.dl - circle.centre;
    return angle.x * X + angle.y * cross(circle.axis, X);
}

ArcCuts makeArcCuts(Outline k, OutlinePoint a, OutlinePoint b, ArcCircle circle)
{
    const HalfAngle t = halfAngleOf(length2(b.dl - a.dl), circle.s2);
    ArcCuts o;
    const vec3 X = onCircle(a, circle, vec2(1.0, 0.0)), Y = onCircle(a, circle, vec2(0.0, 1.0));
    // Cosine and sine of the angle from the arc's begin to its middle, its end, and the point next to
    // the mirror direction (-vx, 0, vz). If the latter is not on the arc, the nearer end serves.
    const vec2 middle = vec2(t.cosine, sqrt(t.sin2));
    const vec2 end = vec2(1.0 - 2.0 * t.sin2, 2.0 * middle.x * middle.y);
    const vec2 next = unitVector(vec2(k.v.y * X.z - k.v.x * X.x, k.v.y * Y.z - k.v.x * Y.x));
    const vec2 nearerEnd = next.x > dot(next, end) ? vec2(1.0, 0.0) : end;
    o.next = dot(next, middle) < t.cosine ? nearerEnd : next;
    const vec2 rest = vec2(dot(end, o.next), end.y * o.next.x - end.x * o.next.y); // to the arc's end
    const vec3 P = o.next.x * X + o.next.y * Y, Q = o.next.x * Y - o.next.y * X;
    const vec3 m = circle.kappa * circle.axis + P + vec3(k.v.x, 0.0, k.v.y);
    const float speed2 = max(length2(stretched(k.alpha, Q)), MIN_LENGTH2);
    o.width = max(0.5 * sqrt(length2(stretched(k.alpha, m)) / speed2), 1e-12);
    // A begin before P has a negative tan(t / 2), sine / (1 + cosine).
    o.begin = quarterAsinh(-o.next.y / (max(1.0 + o.next.x, 1e-6) * o.width));
    o.end = quarterAsinh(rest.y / (max(1.0 + rest.x, 1e-6) * o.width));
    return o;
}

// Returns the point at the share f of the arc, as the cuts count it.
OutlinePoint cutPoint(Outline k, OutlinePoint a, ArcCircle circle, ArcCuts o, float f)
{
    const float x = mix(o.begin, o.end, f);
    const float x2 = x * x;
    const float rest = max(1.0 - x2, 1e-12);
    const float u = o.width * 4.0 * x * (1.0 + x2) / (rest * rest); // tan(t / 2)
    const float inv = 1.0 / (1.0 + u * u);
    const vec2 angle = complexProduct(o.next, vec2((1.0 - u * u) * inv, 2.0 * u * inv));
    return pointInDirection(k, circle.centre + onCircle(a, circle, angle));
}

// Adds an arc. The loop over its pieces runs three times in every lane, because llvmpipe loses lanes
// in a loop within a loop if lanes leave it at different times.
void addLobe(inout Outline k, OutlinePoint a, OutlinePoint b, ArcCircle circle)
{
    if (k.needs.cuts) {
        const float cosine = dot(stretchedDirection(k, a), stretchedDirection(k, b));
        const ArcCuts cuts = makeArcCuts(k, a, b, circle);
        const float halves = growth((CUT_ONCE - cosine) / CUT_ONCE_RANGE);
        const float middle = growth((CUT_TWICE - cosine) / CUT_TWICE_RANGE) / 6.0;
        // The whole arc and then both halves, with weights; or one, two or three pieces.
        const bool blends = halves > 0.0 && halves < 1.0;
        const uint pieces = blends || cosine < CUT_TWICE ? 3u : cosine < CUT_ONCE ? 2u : 1u;
        OutlinePoint from = a;
        uint piece = 1u;
        do {
            if (piece <= pieces) {
                const bool isWhole = blends && piece == 1u;
                const bool isFirst = piece == (blends ? 2u : 1u);
                OutlinePoint to = b;
                if (piece < pieces && !isWhole)
                    to = cutPoint(k, a, circle, cuts, isFirst ? 0.5 - middle : 0.5 + middle);
                addPiece(k, from, to, circle, isWhole ? 1.0 - halves : blends ? halves : 1.0);
                from = to;
                if (isWhole)
                    from = a;
            }
            ++piece;
        } while (piece <= 3u);
    } else {
        addPiece(k, a, b, circle, 1.0);
    }
}

#endif
