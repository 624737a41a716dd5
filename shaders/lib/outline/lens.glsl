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
// angle (disc_lobe.glsl has the control point of a piece of a disc's rim). W1 gives the tangents at the
// ends and thereby the height of the lens, and the curve's weight gives the ratio of its area to that
// of a parabola (segmentShare). The area is exact for a light so small that the lobe is constant over
// it.
//
// Let e be the tangent of the lens' elevation above the middle of the chord, and e f the one above its
// other points; f falls off like a parabola. The directions of a thin strip of the lens, from the chord
// up to the elevation psi = atan(e f), add (psi + sin psi cos psi) / 2 along the chord's direction and
// sin^2 psi / 2 across it. In powers of e the integrals along the chord are
//   (integral of f) e (1 - 16/35 e^2)   and   (integral of f^2) e^2 / 2 (1 - 16/21 e^2),
// where 1 - x is replaced by 1 / (1 + x), which stays positive.
//
// If the control point is nearer to one end, the lens leans towards that end. A lens that leans is a
// sheared one that does not. The shear keeps the area and moves the mean direction of a parabola's lens
// by 2/5 of s / (1 + a) times half the chord, where a is the curve's weight and s the difference of the
// control point's two shares in the ends. The factor LENS_SKEW is less, because lenses are curved.
//
// The formula is good while the lens is not high and not long. Arcs that are long as the lobe sees them
// are cut into two or three pieces.

#ifndef CND_LIB_OUTLINE_LENS
#define CND_LIB_OUTLINE_LENS

#include "lib/outline/points.glsl"

// An arc whose directions of w turn by an angle with a cosine above the first limit is not cut; one
// below the second limit is cut twice. Nothing jumps: below the first limit the sums of the whole arc
// and of its halves are blended, and at the second one the middle piece grows from nothing. The result
// does not depend on the direction in which the arc is walked, so that the sides of a very thin light
// cancel.
const float CUT_ONCE = 0.7, CUT_TWICE = 0.2;
const float CUT_ONCE_RANGE = 0.2, CUT_TWICE_RANGE = 0.2; // blended or growing over this range

const float LENS_SKEW = 0.35;

// The middle control point W1 of an arc, where the end points w0 and w1 have the weight 1, is
// scale A (v + lc) + dw, in units of Outline::D.
struct ArcControl {
    vec3 dw;
    float scale;
};

// Returns the control point of an arc of a circle.
ArcControl controlOf(Outline k, OutlinePoint a, OutlinePoint b, ArcCircle circle)
{
    const HalfAngle t = halfAngleOf(length2(b.dl - a.dl), circle.s2);
    const vec3 dl = (0.5 / t.cosine) * (a.dl + b.dl - 2.0 * t.sin2 * circle.centre);
    return ArcControl(k.invD * stretched(k.alpha, dl), t.cosine);
}

// Adds an arc, or a piece of one, times a weight.
void addPiece(inout Outline k, OutlinePoint a, OutlinePoint b, ArcControl control, float weight)
{
    const vec3 dwA = stretchedOffset(k, a), dwB = stretchedOffset(k, b);
    const vec3 directionA = stretchedDirection(k, a), directionB = stretchedDirection(k, b);
    const vec3 sum = directionA + directionB, chord = directionB - directionA;
    const float ii = a.i * b.i;
    const float root = sqrt(ii);
    // The parts that need the control point come first, so that it occupies no registers later.
    const vec3 middle = control.scale * k.wc + control.dw;
    const float weight2 = root * dot(middle, sum); // times 2 q2
    const float skew2 = root * dot(middle, chord);
    const float height = root * ii *
        dot(stretchedPoint(k, dwA), cross(control.dw - control.scale * dwA, dwB - dwA));

    const float q2 = max(0.25 * length2(sum), 1e-8); // squared cosine of half the chord's angle
    const float q = sqrt(q2);
    const float invQ2 = 1.0 / q2;
    const float H = segmentShare(q) / q;
    const vec3 area = cross(dwA, dwB);
    const vec3 axb = cross(k.wc, dwB - dwA) + area;
    // Squared sine of half the chord's angle. The difference of both unit vectors would have no digits
    // if the light is small.
    const float quarter = 0.25 * min(length2(ii * axb) * invQ2, 4.0);
    const float longer = a.e + b.e + a.e * b.e; // |w0|^2 |w1|^2 - 1
    const float perSine1 = quarter / (1.0 + q) * H; // angle / sine of the chord, minus 1
    const float excess = perSine1 * ii - longer * ii * ii / (1.0 + ii);

    // The second limit keeps the lens below 45 degrees. It is reached only by arcs far from the lobe.
    const float invQuarter = 1.0 / max(quarter, 1e-20);
    const float scale = max(2.0 * q2 + weight2, abs(height) * sqrt(invQuarter) + 1e-12);
    const float share = 0.75 * segmentShare(clamp(0.5 * weight2 * invQ2, 0.0, 1.5));
    const float eSine = height / scale; // e times the sine of half the chord's angle
    const float e2 = eSine * eSine * invQuarter;
    const float along = share * H * eSine / (1.0 + (16.0 / 35.0) * e2);
    const float across = share * (8.0 / 15.0) * e2 * ii * (1.0 + perSine1) / (1.0 + (16.0 / 21.0) * e2);
    const float skew = LENS_SKEW *
        clamp(0.5 * skew2 * invQuarter / (1.0 + 0.5 * weight2 * invQ2), -1.0, 1.0);
    k.specular += weight * (area + (excess - across) * axb + along * (sum + skew * chord));
}

vec2 unitVector(vec2 a)
{
    return a * inversesqrt(max(dot(a, a), MIN_LENGTH2));
}

// Where an arc is divided. The directions of w turn at rates that differ by orders of magnitude along
// an arc that passes the lobe's middle. They turn about evenly in the angle
//   s = t / 2 + atan(tan(t / 2) / width),
// where t is the angle along the arc's circle from the point next to the mirror direction: one half is
// the turn around the lobe, and the other one the way past its middle at the distance `width`.

// Returns `width`. `w`: at the point next to the mirror direction; `turn`: its change there per radian
// of t. The factor 1.25 was fitted.
float passingWidth(vec3 w, vec3 turn)
{
    return clamp(1.25 * sqrt(length2(w) / max(length2(turn), SMALLEST_ANGLE)), 0.001, 1.0);
}

// Returns (cos, sin) of s. `half1`: a vector with the angle t / 2, -90..90 degrees.
vec2 passingAngle(float width, vec2 half1)
{
    return unitVector(complexProduct(vec2(width * half1.x, half1.y), half1));
}

// Returns (cos, sin) of t from those of s, which follow from
//   tan(s) = tan(t / 2) (1 + 1 / width) / (1 - tan^2(t / 2) / width).
vec2 angleFromPassing(float width, vec2 s)
{
    const float c = (1.0 + width) * s.x;
    const float root = sqrt(c * c + 4.0 * width * s.y * s.y);
    const float side = s.y < 0.0 ? -1.0 : 1.0;
    const vec2 half1 =
        s.x >= 0.0 ? vec2(c + root, 2.0 * width * s.y) : vec2(2.0 * abs(s.y), side * (root - c));
    return complexProduct(half1, half1) / max(dot(half1, half1), MIN_LENGTH2);
}

// How an arc of a circle is cut.
struct ArcCuts {
    vec2 next; // cosine and sine of the angle from the arc's begin to the point next to the mirror
    float width;
    vec2 begin; // cosine and sine of s at the arc's begin
    float turn; // difference of s between the arc's ends
};

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
    o.width = passingWidth(stretchedPoint(k, k.invD * stretched(k.alpha, circle.centre + P)),
                           k.invD * stretched(k.alpha, Q));
    o.begin = passingAngle(o.width, vec2(1.0 + o.next.x, -o.next.y));
    const vec2 last = passingAngle(o.width, vec2(1.0 + rest.x, rest.y));
    const float turn = atan(o.begin.x * last.y - o.begin.y * last.x, dot(o.begin, last));
    o.turn = turn + (turn < -0.001 ? 2.0 * PI : 0.0); // less is rounding
    return o;
}

// Returns the point at the share f of the arc, as s counts it.
OutlinePoint cutPoint(Outline k, OutlinePoint a, ArcCircle circle, ArcCuts o, float f)
{
    const vec2 s = complexProduct(o.begin, vec2(cos(f * o.turn), sin(f * o.turn)));
    const vec2 angle = complexProduct(o.next, angleFromPassing(o.width, s));
    return pointInDirection(k, circle.centre + onCircle(a, circle, angle));
}

// Returns the cosine of the angle by which the directions of w turn along an arc, or -1 if that is more
// than 180 degrees. The arc is replaced by the two great circles between its ends and a point of it.
float turnOf(Outline k, OutlinePoint a, OutlinePoint b, ArcControl control)
{
    const vec3 ends = 2.0 * k.wc + stretchedOffset(k, a) + stretchedOffset(k, b);
    const vec3 sum = ends + 2.0 * (control.scale * k.wc + control.dw);
    const vec3 m = sum * inversesqrt(max(length2(sum), MIN_LENGTH2));
    const float first = dot(stretchedDirection(k, a), m), second = dot(m, stretchedDirection(k, b));
    const float sines2 = max((1.0 - first * first) * (1.0 - second * second), 0.0);
    return first + second < 0.0 ? -1.0 : first * second - sqrt(sines2);
}

// Adds an arc. The number of its pieces differs between lanes. Around such a loop, llvmpipe (Mesa 22.3)
// runs a lane that is done with an outer loop once more while others continue. Callers whose count
// differs between lanes must ensure that this turn adds nothing.
void addLobe(inout Outline k, OutlinePoint a, OutlinePoint b, ArcCircle circle)
{
    const ArcControl control = controlOf(k, a, b, circle);
    if (k.needs.cuts) {
        const float cosine = turnOf(k, a, b, control);
        ArcCuts cuts;
        if (!k.needs.lateCuts)
            cuts = makeArcCuts(k, a, b, circle);
        const float halves = smoothstep(0.0, CUT_ONCE_RANGE, CUT_ONCE - cosine);
        const float middle = smoothstep(0.0, CUT_TWICE_RANGE, CUT_TWICE - cosine) / 6.0;
        // The whole arc and then both halves, with weights; or one, two or three pieces.
        const bool blends = halves > 0.0 && halves < 1.0;
        const uint pieces = blends || cosine < CUT_TWICE ? 3u : cosine < CUT_ONCE ? 2u : 1u;
        OutlinePoint from = a;
        uint piece = 1u;
        do {
            const bool isWhole = blends && piece == 1u;
            const bool isFirst = piece == (blends ? 2u : 1u);
            OutlinePoint to = b;
            if (piece < pieces && !isWhole) {
                if (k.needs.lateCuts)
                    cuts = makeArcCuts(k, a, b, circle);
                to = cutPoint(k, a, circle, cuts, isFirst ? 0.5 - middle : 0.5 + middle);
            }
            addPiece(k, from, to, controlOf(k, from, to, circle),
                     isWhole ? 1.0 - halves : blends ? halves : 1.0);
            from = to;
            if (isWhole)
                from = a;
            ++piece;
        } while (piece <= pieces);
    } else {
        addPiece(k, a, b, control, 1.0);
    }
}

#endif
