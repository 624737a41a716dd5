// SPDX-License-Identifier: Apache-2.0
// Form factor of a convex outline, cut at the horizon, by its contour integral: Lambert 1760, in the
// form of Baum, Rushmeier and Winget 1989, F = 1/(2 pi) sum of angle_i n.(Pi x Pi+1) / |Pi x Pi+1|.
#ifndef CND_BENCH_LTC_CONTOUR
#define CND_BENCH_LTC_CONTOUR

#include "lib/math.glsl"

// The terms of the usual sum are proportional to the length of the outline and cancel down to its area,
// so that float32 keeps no digit of a small light. Here every edge P P' is compared with an edge at a
// common distance d, by the number kappa in
//   angle / (sin(angle) |P| |P'|) = (1 + kappa) / d^2.
// With kappa = 0 the sum is the projected area, which follows exactly from the offsets. For a small
// light kappa is small, and it is computed without cancellation.
struct Contour {
    vec3 n;        // normal of the receiver
    vec3 centre;   // relative to the receiver; the outline's points are offsets from here
    float offset2; // typical squared length of an offset
    float invD2;   // 1 / (|centre|^2 + offset2)
    float sum;
    vec3 leaves, enters; // offsets where the outline goes below the horizon and comes back
};

Contour beginContour(vec3 n, vec3 centre, float offset2)
{
    const float invD2 = 1.0 / max(length2(centre) + offset2, MIN_LENGTH2);
    return Contour(n, centre, offset2, invD2, 0.0, vec3(0.0), vec3(0.0));
}

// Returns (asin(z) - z) / z^3, a minimax polynomial in z2 = z^2 in [0, 0.5] with an error of 9.7e-8.
float asinTail(float z2)
{
    float k = 0.0878251772;
    k = k * z2 - 0.0528741847;
    k = k * z2 + 0.0508166768;
    k = k * z2 + 0.0247934903;
    k = k * z2 + 0.0451521326;
    k = k * z2 + 0.0749828032;
    return k * z2 + 0.166666761;
}

// Returns angle / sin(angle) - 1, with full relative precision for small angles.
float angleExcess(float sine, float cosine)
{
    const float s2 = min(sine * sine, 0.5);
    const float tail = asinTail(s2);
    const float x = min(abs(cosine), 0.70710678);
    const float fromCosine = HALF_PI - sign(cosine) * (x + x * x * x * asinTail(x * x));
    const float inverseSine = 1.0 / max(sine, 1e-9);
    const float angle = sine * sine > 0.5 ? fromCosine : PI - sine * (1.0 + s2 * tail);
    const float wide = angle * inverseSine - 1.0;
    return cosine > 0.0 && sine * sine <= 0.5 ? s2 * tail : wide;
}

// Adds the straight edge with the offsets middle + t along, t from t0 to t1. It must be wholly above
// the horizon.
void contourSegment(inout Contour k, vec3 middle, vec3 along, float t0, float t1)
{
    // a x b, where a and b are the ends, without the rounding errors of distant ends.
    const vec3 axb = (t1 - t0) * cross(k.centre + middle, along);
    const float axb2 = length2(axb);
    const float projected = (t1 - t0) * dot(k.n, cross(middle, along));
    const float height = dot(k.n, axb);
    // qa = |a|^2 / d^2 - 1 and qb = |b|^2 / d^2 - 1.
    const vec3 from = middle + t0 * along;
    const float qa = (2.0 * dot(k.centre, from) + length2(from) - k.offset2) * k.invD2;
    const vec3 a = k.centre + from;
    const vec3 to = middle + t1 * along;
    const float qb = (2.0 * dot(k.centre, to) + length2(to) - k.offset2) * k.invD2;
    const vec3 b = k.centre + to;
    const float q = qa + qb + qa * qb;
    // The floor prevents a division by 0 if an end is at the receiver. Such an edge adds nothing,
    // because a x b is 0.
    const float w = max(sqrt(length2(a) * k.invD2 * length2(b) * k.invD2), 1e-12);
    const float invW = 1.0 / w;
    const float lengths = -q / (w + w * w); // d^2 / (|a| |b|) - 1
    const float sine = min(sqrt(axb2) * k.invD2 * invW, 1.0);
    const float excess = angleExcess(sine, clamp(dot(a, b) * k.invD2 * invW, -1.0, 1.0));
    k.sum += projected + (excess + lengths + excess * lengths) * height;
}

// Adds the part above the horizon of the outline's next edge, which goes from middle - along to
// middle + along.
void contourEdge(inout Contour k, vec3 middle, vec3 along)
{
    const float height = dot(k.n, k.centre + middle);
    const float slope = dot(k.n, along);
    const bool up = height - slope >= 0.0;
    const bool upAfter = height + slope >= 0.0;
    if (!up && !upAfter)
        return;
    const float crossing = clamp(-height / (abs(slope) > 0.0 ? slope : 1.0), -1.0, 1.0);
    if (!upAfter)
        k.leaves = middle + crossing * along;
    if (!up)
        k.enters = middle + crossing * along;
    contourSegment(k, middle, along, up ? -1.0 : crossing, upAfter ? 1.0 : crossing);
}

// Closes the outline along the horizon and returns its form factor, 0..1, which is the same for both
// orientations of the outline.
float contourFormFactor(inout Contour k)
{
    // If no edge crosses the horizon, both offsets are zero and this adds nothing.
    contourSegment(k, k.leaves, k.enters - k.leaves, 0.0, 1.0);
    return clamp(abs(k.sum) * k.invD2 * (0.5 * INV_PI), 0.0, 1.0);
}

// Returns the form factor of the parallelogram with the corners centre +- u +- v.
float parallelogramFormFactor(vec3 n, vec3 centre, vec3 u, vec3 v)
{
    Contour k = beginContour(n, centre, length2(u) + length2(v));
    contourEdge(k, -v, u);
    contourEdge(k, u, v);
    contourEdge(k, v, -u);
    contourEdge(k, -u, -v);
    return contourFormFactor(k);
}

#endif
