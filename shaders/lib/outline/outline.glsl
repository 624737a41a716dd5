// SPDX-License-Identifier: Apache-2.0
// Light from an emitter by its outline, as the receiver sees it on the sphere of directions. Edges of
// polygons and sides of tubes are arcs of great circles, and the ends of tubes are arcs of small
// circles. The rim of a disc is divided into pieces that are taken for arcs of conics (disc_lobe.glsl).
// One walk along the outline gives the diffuse and the specular response.
//
// Both are integrals over the emitter's directions that Stokes' theorem turns into integrals along
// its outline, counterclockwise as the receiver sees it:
//   2 pi f   = closed integral of l x dl,
//   2 pi Phi = closed integral of (w x dw) / |w|^2,   w = A (v + l),   A = diag(1, 1, alpha).
// f is the vector irradiance for luminance 1, divided by pi; its component along the normal is the
// form factor (Lambert 1760). w is the half vector in the space in which the GGX lobe D (n . h) dw_h is
// a clamped cosine (Heitz, Dupuy, Hill and Neubelt 2016; see specular/conic_region.glsl). So Phi_z is
// the integral of the lobe over the emitter, and the mean slope of its half vectors is
// alpha (Phi_x, Phi_y) / Phi_z. Where the outline is below the horizon, the horizon closes it.
//
// Sums of such terms along an outline are proportional to its length and cancel down to its area. For
// small lights float32 would keep no digit of them. So every direction is written as the direction
// lc to the emitter's centre plus a small difference dl, and every term is the difference of its value
// and of the value that it would have if all |w| were equal to a common length D. The latter add up to
// the area of a planar polygon, for which only the products dl x dl of neighbours are summed.
//
// Vectors are in the frame of the receiver: z is its normal, and x is along the part of v (the
// direction to the eye) that is perpendicular to the normal.
#ifndef CND_LIB_OUTLINE_OUTLINE
#define CND_LIB_OUTLINE_OUTLINE

#include "lib/outline/lens.glsl"

// Returns the great circle through two points, which lie less than 180 degrees apart.
ArcCircle greatCircle(Outline k, OutlinePoint a, OutlinePoint b)
{
    const vec3 axb = cross(k.lc, b.dl - a.dl) + cross(a.dl, b.dl); // the product of both directions
    return ArcCircle(axb * inversesqrt(max(length2(axb), MIN_LENGTH2)), 0.0, 1.0, -k.lc);
}

// Adds the arc of a circle between two points. The arc must be above the horizon, and shorter than 180
// degrees; small circles should be cut into arcs of at most 120 degrees. `diffuse`: add it to f as
// well.
void addArc(inout Outline k, OutlinePoint a, OutlinePoint b, ArcCircle circle, bool diffuse)
{
    const vec3 chord = b.dl - a.dl;
    const vec3 area = cross(a.dl, b.dl);
    if (diffuse) {
        // The integral of l x dl is the product of the ends plus axis s2 (angle - sin(angle)).
        const HalfAngle t = halfAngleOf(length2(chord), circle.s2);
        k.diffuse += (2.0 * circle.s2 * sqrt(t.sin2) * t.sin2 / (1.0 + t.cosine) *
                      segmentShare(t.cosine)) * circle.axis + area;
    }
    const vec3 la = k.lc + a.dl, lb = k.lc + b.dl;
    const float axbz = k.lc.x * chord.y - k.lc.y * chord.x + area.z;
    k.inside = k.inside && (axbz > 0.0 || circle.axis.z > circle.kappa);
    k.low = min(k.low, min(la.z, lb.z));
    k.high = max(k.high, max(la.z, lb.z));
    // The highest and the lowest point of the circle, if the arc has them between its ends.
    const float reach = sqrt(max(circle.s2 * (1.0 - circle.axis.z * circle.axis.z), 0.0));
    const float top = circle.kappa * circle.axis.z + reach, bottom = top - 2.0 * reach;
    const float riseA = circle.axis.x * la.y - circle.axis.y * la.x;
    const float riseB = circle.axis.x * lb.y - circle.axis.y * lb.x;
    if (riseA > 0.0 && riseB < 0.0)
        k.high = max(k.high, top);
    if (riseA < 0.0 && riseB > 0.0 && bottom > 0.0)
        k.low = min(k.low, bottom);
    if (k.needs.lobe)
        addLobe(k, a, b, circle);
}

void addEdge(inout Outline k, OutlinePoint a, OutlinePoint b)
{
    addArc(k, a, b, greatCircle(k, a, b), true);
}

// Closes an outline that crosses the horizon by the arc of the horizon between its crossings. The
// integrals along it are elementary: |A (v + l)|^2 is A0 + 2 vx l.x there, and J is the integral of its
// inverse.
void addHorizon(inout Outline k)
{
    const OutlinePoint pa = pointInDirection(k, k.leaves), pb = pointInDirection(k, k.enters);
    const vec3 a = k.lc + pa.dl, b = k.lc + pb.dl;
    const vec3 chord = pb.dl - pa.dl;
    const vec3 area = cross(pa.dl, pb.dl);
    const vec3 axb = cross(k.lc, chord) + area;
    const vec2 h = a.xy + b.xy;
    const float norm = max(sqrt(dot(h, h)), 1e-9);
    const float cosine = 0.5 * norm, sine = axb.z / norm; // of half the arc
    const float angle = 2.0 * atan(sine, cosine);
    // The horizon is a great circle. The form of addEdge keeps the digits of short arcs but cannot be
    // used for arcs of 180 degrees.
    const HalfAngle t = halfAngleOf(length2(chord), 1.0);
    const float excess = t.sin2 / (1.0 + t.cosine) * segmentShare(t.cosine) / t.cosine;
    k.diffuse += area + (t.sin2 < 0.5 ? excess * axb : vec3(0.0, 0.0, angle) - axb);
    k.low = 0.0;
    if (k.needs.lobe) {
        const float vx = k.v.x, vz = k.v.y, a2 = k.alpha * k.alpha;
        const float hz = k.alpha * vz;
        const float A0 = 1.0 + vx * vx + hz * hz;
        // sqrt(A0^2 - 4 vx^2)
        const float root = vz * sqrt(vz * vz + a2 * (2.0 + 2.0 * vx * vx + hz * hz));
        const float v1 = vx * h.x / norm, v2 = vx * h.y / norm;
        // A0 cosine + 2 v1 without cancellation.
        const float next = (1.0 + v1) * (1.0 + v1) + v2 * v2 + hz * hz -
            A0 * sine * sine / (1.0 + cosine);
        const float J = 2.0 / root * atan(root * sine, next);
        const float fromA = (vx + a.x) * (vx + a.x) + a.y * a.y + hz * hz; // A0 + 2 vx a.x
        const float fromB = (vx + b.x) * (vx + b.x) + b.y * b.y + hz * hz;
        const bool alongNormal = vx < 0.01;
        const float half1 = 0.5 / max(vx, 0.01);
        const float Jx = alongNormal ? (b.y - a.y) / A0 : (angle - A0 * J) * half1;
        const float Jy = alongNormal ? (a.x - b.x) / A0 : log(fromA / fromB) * half1;
        const vec3 whole = vec3(-hz * Jx, -hz * Jy, 0.5 * (angle + vz * vz * (1.0 - a2) * J));
        k.specular += whole - cross(k.wc, stretchedOffset(k, pb) - stretchedOffset(k, pa));
    }
}

// enterAt notes the point `dl` (OutlinePoint::dl) where the outline comes back above the horizon, and
// leaveAt the point where it goes below it. An edge and an arc compute their common point in different
// ways. If it is on the horizon, rounding may let only one of them cross the horizon there. So the
// first crossing counts as both until the other is found, and if it never is, the arc of the horizon
// between them is empty.
void enterAt(inout Outline k, vec3 dl)
{
    k.leaves = k.crosses ? k.leaves : dl;
    k.enters = dl;
    k.crosses = true;
}

void leaveAt(inout Outline k, vec3 dl)
{
    k.enters = k.crosses ? k.enters : dl;
    k.leaves = dl;
    k.crosses = true;
}

// Adds the part above the plane of k.tilt of the edge between two points, which are given by their
// offsets.
void addClippedEdge(inout Outline k, vec3 from, vec3 to)
{
    const vec3 up = upOf(k);
    const float centre = k.distance * dot(up, k.lc);
    const float za = centre + dot(up, from), zb = centre + dot(up, to);
    if (za >= 0.0 || zb >= 0.0) {
        const float fall = za - zb;
        const vec3 crossing =
            from + clamp(za / (abs(fall) > 0.0 ? fall : 1.0), 0.0, 1.0) * (to - from);
        const OutlinePoint a = pointAt(k, za < 0.0 ? crossing : from);
        const OutlinePoint b = pointAt(k, zb < 0.0 ? crossing : to);
        if (za < 0.0)
            enterAt(k, a.dl);
        if (zb < 0.0)
            leaveAt(k, b.dl);
        addEdge(k, a, b);
    }
}

#endif
