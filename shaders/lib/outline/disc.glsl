// SPDX-License-Identifier: Apache-2.0
// The outline of a disc light.
#ifndef CND_LIB_OUTLINE_DISC
#define CND_LIB_OUTLINE_DISC

#include "lib/outline/rectangle.glsl"

const float DISC_SERIES_LIMIT = 0.35; // discArcIntegrals uses the series up to this e
const int DISC_SERIES_TERMS = 9;      // the first term left out is below 0.18^9 = 2e-7

// The outline of a disc is not a circle on the sphere of directions. For the specular lobe it is
// replaced by this many circle arcs, each through three points of the outline. The form factor is
// exact, and discOutline corrects the area that the arcs enclose by it.
const uint DISC_ARCS = 6u;
const vec2 DISC_HALF_STEP = vec2(0.86602540, 0.50000000); // cosine and sine of 180 degrees / DISC_ARCS

// Returns the integrals over phi of cos(phi) / (1 + e cos(phi)) times 1, times cos(phi) and times
// sin(phi), for 0 <= e < 1 and root = sqrt(1 - e^2). `from` and `to` are (cos, sin) of the first and
// the last phi, which are the angle `turn` apart.
vec3 discArcIntegrals(float e, float root, vec2 from, vec2 to, float turn)
{
    const float delta = to.y - from.y;
    // The closed form. The integral of 1 / (1 + e cos(phi)) is E / root, where E is Kepler's eccentric
    // anomaly of the true anomaly phi. It is computed from E - phi, which has no jumps.
    const float ratio = e / (1.0 + root);
    const float even = turn - 2.0 * (atan(ratio * to.y / (1.0 + ratio * to.x)) -
                                     atan(ratio * from.y / (1.0 + ratio * from.x)));
    const float invE = 1.0 / max(e, 1e-6);
    vec3 closed;
    closed.x = (turn - even / root) * invE;
    closed.y = (delta - closed.x) * invE;
    closed.z = (log((1.0 + e * to.x) / (1.0 + e * from.x)) * invE - (to.x - from.x)) * invE;
    // The Fourier series, whose terms fall by a ratio of about e / 2. It serves small e, for which the
    // closed form cancels.
    vec2 powerFrom = from;
    vec2 powerTo = to;
    float factor = 1.0;
    vec2 before = vec2(turn, 0.0); // integrals of cos(k phi), sin(k phi) for k = 0, then k = 1
    vec2 now = vec2(to.y - from.y, from.x - to.x);
    vec3 series = -e * vec3(turn, now.x, now.y);
    for (int k = 1; k <= DISC_SERIES_TERMS; ++k) {
        powerFrom = complexProduct(powerFrom, from);
        powerTo = complexProduct(powerTo, to);
        const vec2 next = vec2(powerTo.y - powerFrom.y, powerFrom.x - powerTo.x) / float(k + 1);
        series += factor * vec3(2.0 * now.x, next.x + before.x, next.y - before.y);
        before = now;
        now = next;
        factor *= -ratio;
    }
    return e > DISC_SERIES_LIMIT ? closed : series / (root + root * root);
}

// A disc seen from outside its plane. The angle phi on its rim is counted from u, which points away
// from the receiver, towards v; this is counterclockwise as the receiver sees it. Both are radii. The
// squared distance of a point of the rim is D2 (1 + e cos(phi)).
struct DiscView {
    vec3 u, v, normal; // normal: u x v / radius^2, away from the receiver
    float radius, D2, e, root;
    // (cos, sin) of the first and the last phi above the horizon, and the angle between them.
    vec2 from, to;
    float turn;
    bool above, below; // the whole rim is above the horizon, or below it
};

// `normal`: towards the receiver. `across`: whether the disc may cross the horizon.
DiscView viewDisc(vec3 centre, vec3 normal, float radius, bool across)
{
    DiscView o;
    const float height = dot(centre, normal);
    const vec3 inPlane = centre - height * normal;
    const float r2 = length2(inPlane);
    const bool offAxis = r2 > 1e-12 * height * height && r2 > MIN_LENGTH2;
    const float offset = offAxis ? sqrt(r2) : 0.0;
    o.normal = -normal;
    o.radius = radius;
    o.u = radius * (offAxis ? inPlane * inversesqrt(r2) : anyPerpendicular(normal));
    o.v = cross(o.normal, o.u);
    o.D2 = max(length2(centre) + radius * radius, MIN_LENGTH2);
    o.e = min(2.0 * offset * radius / o.D2, 0.999999);
    const float nearer = (offset - radius) * (offset - radius) + height * height;
    const float farther = (offset + radius) * (offset + radius) + height * height;
    o.root = clamp(sqrt(nearer / o.D2 * (farther / o.D2)), 1e-6, 1.0);
    o.from = vec2(1.0, 0.0);
    o.to = o.from;
    o.turn = 2.0 * PI;
    o.above = true;
    o.below = false;
    if (across) {
        // The part above the horizon has its middle at the highest point of the rim.
        const vec2 tilt = vec2(o.u.z, o.v.z);
        const float tilt2 = dot(tilt, tilt);
        const float inv = inversesqrt(max(tilt2, MIN_LENGTH2));
        const vec2 middle = tilt2 > MIN_LENGTH2 ? tilt * inv : vec2(1.0, 0.0);
        const float cosine = clamp(-centre.z * inv, -1.0, 1.0);
        const float sine = sqrt(max(1.0 - cosine * cosine, 0.0));
        o.from = complexProduct(middle, vec2(cosine, -sine));
        o.to = complexProduct(middle, vec2(cosine, sine));
        o.turn = 2.0 * atan(sine, cosine);
        o.above = cosine <= -1.0;
        o.below = cosine >= 1.0;
        if (o.above) {
            o.from = vec2(1.0, 0.0);
            o.to = o.from;
        }
    }
    return o;
}

// Returns the integral of l x dl along the rim above the horizon, less lc times the difference of its
// ends. With the squared distance above it splits into elementary integrals and, for small discs, keeps
// its digits.
vec3 discRim(Outline k, DiscView d, vec3 first, vec3 last, bool across)
{
    const float invD2 = 1.0 / d.D2;
    vec3 i = (2.0 * PI / (d.root + d.root * d.root)) * vec3(-d.e, 1.0, 0.0);
    vec3 ends = vec3(0.0);
    if (across) {
        if (!d.above)
            i = discArcIntegrals(d.e, d.root, d.from, d.to, d.turn);
        // The ends' share is C x P (1 / D2 - 1 / (|C| |P|)), without cancellation.
        const vec3 centre = k.distance * k.lc;
        const float firstLonger = 2.0 * dot(centre, first) + length2(first);
        const float lastLonger = 2.0 * dot(centre, last) + length2(last);
        const float c = k.distance;
        const float firstLength = sqrt(max(length2(centre + first), MIN_LENGTH2));
        const float lastLength = sqrt(max(length2(centre + last), MIN_LENGTH2));
        const float r2 = d.radius * d.radius;
        ends = (c * lastLonger / (lastLength + c) - r2) / (c * lastLength) * cross(centre, last) -
            (c * firstLonger / (firstLength + c) - r2) / (c * firstLength) * cross(centre, first);
    }
    const vec3 turning = d.radius * d.radius * (d.turn - d.e * i.x) * d.normal;
    return invD2 * (turning + ends - d.e * cross(k.distance * k.lc, i.y * d.v - i.z * d.u));
}

// Returns the circle through three points, counterclockwise.
ArcCircle circleThrough(Outline k, OutlinePoint a, OutlinePoint b, OutlinePoint c)
{
    // In units of |c - a|, so that no product is too small for a float.
    const float perChord = inversesqrt(max(length2(c.dl - a.dl), SMALLEST_ANGLE));
    const vec3 ab = perChord * (b.dl - a.dl), ac = perChord * (c.dl - a.dl);
    const vec3 normal = cross(ab, ac);
    const float inv = inversesqrt(max(length2(normal), 1e-20));
    const vec3 axis = inv * normal;
    const float s2 = 0.25 * (length2(ab) * inv) * (length2(ac) * inv) * length2(c.dl - b.dl);
    const vec3 fromA = 0.5 * inv * inv / perChord *
        (cross(normal, ab) + length2(ab) * cross(ac, normal)); // |ac| is 1
    const float kappa = sqrt(max(1.0 - s2, 0.0));
    // The rim of a disc that is seen from the side is almost a great circle.
    ArcCircle circle = ArcCircle(axis, kappa, max(s2, SMALLEST_ANGLE), a.dl + fromA);
    if (!(s2 < 0.99))
        circle = greatCircle(k, a, c);
    return circle;
}

// The points between which the rim is replaced by arcs lie closer where the rim is closer to the
// receiver: they are equally far apart in the angle t with tan(phi / 2) = stretch tan(t / 2). Returns
// (cos, sin) of phi for those of t; with 1 / stretch in place of stretch it is the inverse.
vec2 stretchedAngle(vec2 t, float stretch)
{
    const float s2 = stretch * stretch;
    const float inv = 1.0 / max(1.0 + s2 + (1.0 - s2) * t.x, 1e-12);
    return vec2(1.0 - s2 + (1.0 + s2) * t.x, 2.0 * stretch * t.y) * inv;
}

// Returns |a| / |b|, or 1 if b is 0. The squares of the components may be too small for a float.
float lengthRatio(vec3 a, vec3 b)
{
    const float largest = max(max(abs(b.x), abs(b.y)), abs(b.z));
    const float inv = 1.0 / max(largest, SMALLEST_ANGLE);
    const vec3 p = inv * a, q = inv * b;
    return largest > SMALLEST_ANGLE ? sqrt(length2(p) / length2(q)) : 1.0;
}

// Returns the response to a disc. `toCentre`: from the receiver to its centre; `facing`: unit vector in
// the direction that the disc faces.
OutlineResponse discOutline(ConicPoint p, OutlineFrame f, vec3 toCentre, vec3 facing, float radius,
                            bool twoSided, OutlineNeeds needs)
{
    const vec3 centre = toFrame(f, toCentre), normal = toFrame(f, facing);
    const vec3 towards = dot(normal, centre) < 0.0 ? normal : -normal;
    const DiscView d = viewDisc(centre, towards, radius, needs.across);
    const float stretched2 = length2(stretched(p.alpha, d.u)) + length2(stretched(p.alpha, d.v));
    Outline k = beginOutline(p, f, toCentre, centre, stretched2, needs);
    const vec3 first = d.from.x * d.u + d.from.y * d.v;
    const vec3 last = d.to.x * d.u + d.to.y * d.v;
    const bool seen = seesFlatLight(centre, normal, radius, twoSided) && !d.below;
    vec3 rim = discRim(k, d, first, last, needs.across);
    if (needs.lobe) {
        // With this stretch the rim's nearest and farthest points pass by equally fast.
        const float stretch = sqrt((1.0 + d.e) / d.root);
        vec2 turn = DISC_HALF_STEP;
        vec2 at = vec2(1.0, 0.0);
        if (needs.across && !d.above) {
            at = stretchedAngle(d.from, 1.0 / stretch);
            const vec2 to = stretchedAngle(d.to, 1.0 / stretch);
            // An angle close to 0 or to a full turn may have the wrong sign by rounding. d.turn tells
            // them apart, because angles above pi are not stretched to less than 0.1.
            const float angle = atan(to.y * at.x - to.x * at.y, dot(to, at));
            const bool more = angle < (d.turn > PI ? 0.01 : -0.01);
            const float whole = max(angle + (more ? 2.0 * PI : 0.0), 0.0);
            const float step = whole * (0.5 / float(DISC_ARCS));
            turn = vec2(cos(step), sin(step));
        }
        OutlinePoint a = pointAt(k, first);
        uint arc = 1u;
        do {
            at = complexProduct(at, turn);
            const vec2 middle = stretchedAngle(at, stretch);
            at = complexProduct(at, turn);
            const vec2 end = arc == DISC_ARCS ? d.to : stretchedAngle(at, stretch);
            const OutlinePoint b = pointAt(k, middle.x * d.u + middle.y * d.v);
            const OutlinePoint c = pointAt(k, end.x * d.u + end.y * d.v);
            addArc(k, a, c, circleThrough(k, a, b, c), true);
            a = c;
            ++arc;
        } while (arc <= DISC_ARCS);
    }
    if (needs.across && !d.above) {
        k.enters = differenceTo(k, first);
        k.leaves = differenceTo(k, last);
        const vec3 arcs = k.diffuse;
        addHorizon(k);
        rim += k.diffuse - arcs;
    }
    // The arcs enclose a slightly wrong area. The vector irradiance of the rim is exact, and its ratio
    // to that of the arcs corrects the specular lobe.
    k.specular *= needs.lobe ? lengthRatio(rim, k.diffuse) : 1.0;
    k.diffuse = rim;
    const OutlineResponse o = outlineResponse(p, k);
    return OutlineResponse(seen ? o.formFactor : 0.0, seen ? o.specular : vec2(0.0));
}

#endif
