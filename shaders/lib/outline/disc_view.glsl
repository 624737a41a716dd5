// SPDX-License-Identifier: Apache-2.0
// A disc light as a receiver sees it, and the diffuse integral along its rim, which is exact.
#ifndef CND_LIB_OUTLINE_DISC_VIEW
#define CND_LIB_OUTLINE_DISC_VIEW

#include "lib/outline/outline.glsl"

const float DISC_SERIES_LIMIT = 0.5;  // discArcIntegrals uses the series up to this e
const int DISC_SERIES_TERMS = 12;     // the first term left out is below 0.27^12 = 2e-7

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
    // (cos, sin) of the first and the last phi above the plane of Outline::tilt, and the angle between
    // them.
    vec2 from, to;
    float turn;
    bool above, below; // the whole rim is above that plane, or below it
};

// `normal`: towards the receiver. The result has the whole rim.
DiscView viewDisc(vec3 centre, vec3 normal, float radius)
{
    DiscView o;
    const float height = dot(centre, normal);
    // Close to the axis the difference is mostly rounding, which is not perpendicular to the normal.
    const vec3 aside = centre - height * normal;
    const vec3 inPlane = aside - dot(aside, normal) * normal;
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
    return o;
}

// Restricts the rim to the part above the plane of k.tilt.
void clipRim(inout DiscView o, Outline k)
{
    // This part has its middle at the highest point of the rim.
    const vec3 up = upOf(k);
    const vec2 tilt = vec2(dot(up, o.u), dot(up, o.v));
    const float tilt2 = dot(tilt, tilt);
    const float inv = inversesqrt(max(tilt2, MIN_LENGTH2));
    const vec2 middle = tilt2 > MIN_LENGTH2 ? tilt * inv : vec2(1.0, 0.0);
    const float cosine = clamp(-k.distance * dot(up, k.lc) * inv, -1.0, 1.0);
    const float sine = sqrt(max(1.0 - cosine * cosine, 0.0));
    o.above = cosine <= -1.0;
    o.below = cosine >= 1.0;
    o.from = o.above ? vec2(1.0, 0.0) : complexProduct(middle, vec2(cosine, -sine));
    o.to = o.above ? o.from : complexProduct(middle, vec2(cosine, sine));
    o.turn = 2.0 * atan(sine, cosine);
}

// Returns the integral of l x dl along the rim above the plane, less lc times the difference of its
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

#endif
