// SPDX-License-Identifier: Apache-2.0
// The lobe over the part of a sphere light above the horizon (conic_region.glsl: over a whole light).
//
// By Stokes' theorem the vector irradiance of a region of directions is an integral along its border,
//   Phi = (1 / 2 pi) closed integral of (w x dw) / |w|^2,
// which for a polygon is Lambert's sum over its edges. Here w = (m_x, m_y, alpha m_z), where the half
// vector m = l + v is not normalised. The border has two arcs: a part of the cap's rim, which is a part
// of an ellipse in w, and a part of the horizon, l_z = 0. Both integrals have closed forms.
#ifndef CND_LIB_SPECULAR_CONIC_CLIP
#define CND_LIB_SPECULAR_CONIC_CLIP

#include "lib/specular/conic_region.glsl"
#include "lib/specular/conic_shading.glsl"

// Returns (atan(t) - t) / t^3, a polynomial in t^2 for t in [0, 1]. The term t of the arc tangent is
// exact.
vec2 atanTail(vec2 t2)
{
    vec2 k = -CONIC_ATAN_T15 * t2 + CONIC_ATAN_T13;
    k = k * t2 - CONIC_ATAN_T11;
    k = k * t2 + CONIC_ATAN_T9;
    k = k * t2 - CONIC_ATAN_T7;
    k = k * t2 + CONIC_ATAN_T5;
    return k * t2 - CONIC_ATAN_T3;
}

// Returns atan(y, x) of two pairs with a single division, and 0 for x = y = 0.
vec2 atan2Pair(vec2 y, vec2 x)
{
    const vec2 ax = abs(x);
    const vec2 ay = abs(y);
    const vec2 larger = max(max(ax, ay), 1e-18);
    const vec2 t = min(ax, ay) * larger.yx * (1.0 / (larger.x * larger.y));
    const vec2 t2 = t * t;
    const vec2 first = t + t * t2 * atanTail(t2);
    const vec2 quarter = mix(first, HALF_PI - first, greaterThan(ay, ax));
    const vec2 upper = mix(quarter, PI - quarter, lessThan(x, vec2(0.0)));
    return mix(upper, -upper, lessThan(y, vec2(0.0)));
}

// Returns atanh(y / x) for |y| < x.
float atanhRatio(float y, float x)
{
    return 0.5 * log(max(x + y, 1e-30) / max(x - y, 1e-30));
}

// Returns the largest root of p(t) = t^3 + tr t^2 + m2 t - D0, D0 > 0. Halley's iteration starts from
// the smaller of two upper bounds (the start of wholeCap is no bound for centres below the horizon):
//   A, for tr > 0: the root of tr t^2 + m2 t = D0, which leaves out the cubic term.
//   B, for m2 < 0: since t (t^2 + tr t + m2) = D0, the positive root tq of the bracket is a lower
//      bound. So the root of t^2 + tr t + m2 = D0 / tq is an upper bound.
// At least one of them exists: p has one positive and two negative roots, so m2 >= 0 implies tr > 0.
float conicRoot(float tr, float m2, float D0)
{
    const float boundA = 2.0 * D0 / max(m2 + sqrt(max(m2 * m2 + 4.0 * tr * D0, 0.0)), 1e-30);
    const float qd = sqrt(max(tr * tr - 4.0 * m2, 0.0));
    const float tq = tr > 0.0 ? -2.0 * m2 / (tr + qd) : 0.5 * (qd - tr);
    const float mb = m2 - D0 / max(tq, 1e-30);
    const float qb = sqrt(max(tr * tr - 4.0 * mb, 0.0));
    const float boundB = tr > 0.0 ? -2.0 * mb / (tr + qb) : 0.5 * (qb - tr);
    const float negative = tr > 0.0 ? min(boundA, boundB) : boundB;
    float lam = max(m2 < 0.0 ? negative : boundA, 1e-12); // against rounding; no cap here is smaller
    lam = halley(lam, tr, m2, D0);
    return halley(lam, tr, m2, D0);
}

// The frame of a cap, x = c_t / |c_t|, y = n x x, z = n, in which clippedCap and lightHeights work.
struct CapFrame {
    float sinC;   // |n x c|
    float v1, v2; // v . x, v . y
};

CapFrame makeCapFrame(ConicPoint p, vec3 c, float NoC)
{
    CapFrame f;
    f.sinC = sqrt(max(1.0 - NoC * NoC, 1e-12));
    const float inv = 1.0 / f.sinC;
    f.v1 = (dot(p.v, c) - p.NoV * NoC) * inv;
    f.v2 = dot(p.vxn, c) * inv;
    return f;
}

// The two directions in which a cap's rim meets the horizon: (cp, +-sp, 0) in the frame of the cap,
// where cp = cos S / |c_t| follows from l . c = cos S and l_z = 0.
struct Chord {
    float cp, sp, cm; // cm = 1 - cp
};

Chord makeChord(SphereCap cap, float sinC)
{
    Chord o;
    const float inv = 1.0 / sinC;
    const float sp2 = max(0.0, (cap.s * cap.s - cap.NoC * cap.NoC) * inv * inv);
    o.cp = min((1.0 - cap.omc) * inv, 1.0);
    o.sp = sqrt(sp2);
    o.cm = sp2 / (1.0 + o.cp);
    return o;
}

// Returns the horizon's part of 2 pi Phi. On the horizon l is on the unit circle and
// w = (l + v_t, alpha NoV), so |w|^2 = A0 + 2 v_t . l, and w x dw = (-alpha NoV l, 1 + v_t . l) times
// the differential of the angle. What remains are the integrals of 1, v_t . l and v_t x l, each divided
// by A0 + 2 v_t . l, over the angles from -pc to pc. The first, J0, is an arc tangent; the second is
// pc - A0 J0 / 2; the third is half the logarithm of the ratio of |w|^2 at the two ends. Here v_t is
// the component of v in the plane of the surface, and +-pc are the angles of the ends of the chord.
vec3 horizonArc(ConicPoint p, CapFrame f, Chord chord)
{
    const float hz = p.alpha * p.NoV;
    const float hz2 = hz * hz;
    const float NoV2 = p.NoV * p.NoV;
    const float A0 = 1.0 + p.vv + hz2;
    const float rh = p.NoV * sqrt(NoV2 + (2.0 * (1.0 + p.vv) + hz2) * p.a2); // sqrt(A0^2 - 4 vv)
    const float E0 = (1.0 + f.v1) * (1.0 + f.v1) + f.v2 * f.v2 + hz2;
    const vec2 angles = atan2Pair(chord.sp * vec2(rh, 1.0), vec2(E0 - A0 * chord.cm, chord.cp));
    const float J0 = 2.0 / rh * angles.x;
    const float pc = angles.y;
    const float pp = pc - 0.5 * A0 * J0;
    const float qq = -atanhRatio(2.0 * f.v2 * chord.sp, E0 - 2.0 * f.v1 * chord.cm);
    const float scale = -hz / max(p.vv, 1e-4);
    const vec2 across = p.vv > 1e-4 ? vec2(pp * f.v1 - qq * f.v2, pp * f.v2 + qq * f.v1) * scale
                                    : vec2(-2.0 * hz * chord.sp / A0, 0.0);
    return vec3(across, pc + 0.5 * NoV2 * p.oneMinusA2 * J0);
}

// The cone w^T q w <= 0 of a cap, where q is the matrix of conic_region.glsl.
struct CapCone {
    float qxx, qxy, qxz, qyy, qyz, qzz; // the elements of q times sg
    float sg;                     // 1 or -1: see makeCapCone
    float tr, D0, lam;            // t^3 + tr t^2 + m2 t - D0 has lam as its largest root
};

CapCone makeCapCone(ConicPoint p, SphereCap cap, CapFrame f)
{
    const float cx = f.sinC;
    const float cz = cap.NoC;
    const float vz = p.NoV;
    const float v1 = f.v1;
    const float v2 = f.v2;
    const float s2 = cap.s * cap.s;
    const vec3 dl = cap.c - p.mirror;
    const float z0 = 0.5 * length2(dl) - cap.omc;
    const float G = max(length2(vz * dl - (cz - vz) * p.mirror), 1e-14);
    const float t = v1 * cx;
    const float w2 = v2 * v2 * cx * cx;
    const float hh = 0.5 * ((v1 + cx) * (v1 + cx) + v2 * v2 + (vz + cz) * (vz + cz)); // 1 + v . c
    // k < 0 if the cap holds -v, which is possible for lights ahead of a grazing view. The quadratic
    // form of the same cone then has the other sign, sg.
    const float signedK = hh - cap.omc;
    CapCone q;
    q.sg = signedK < 0.0 ? -1.0 : 1.0;
    const float ak = max(abs(signedK), 1e-4 * hh);
    const float k = q.sg * ak;
    const float AC = 2.0 * (k - t);
    const float Z = z0 * p.invA2;
    q.D0 = ak * s2 * p.invA2;
    q.tr = q.sg * (AC + Z);
    const float m2 = k * (k - 2.0 * t) - w2 + AC * Z - G * p.invA2;
    q.lam = conicRoot(q.tr, m2, q.D0);

    const float invAlpha = 1.0 / p.alpha;
    q.qxx = q.sg * (k - 2.0 * t);
    q.qxy = -q.sg * v2 * cx;
    q.qxz = -q.sg * (v1 * cz + vz * cx) * invAlpha;
    q.qyy = ak;
    q.qyz = -q.sg * v2 * cz * invAlpha;
    q.qzz = q.sg * Z;
    return q;
}

// The principal axes of a cone: e along it, e1 and e2 across it.
struct ConeAxes {
    vec3 e, e1, e2;
    float A2, B2; // squared tangents a^2 and b^2 of its half angles along e1 and e2
};

// `inside` is any vector inside the cone.
ConeAxes makeConeAxes(CapCone q, vec3 inside)
{
    // The axis e of the cone. The adjugate of q + lam I is a multiple of e e^T, so it maps `inside` to
    // a vector E along the axis that points into the cone.
    const float X = q.qxx + q.lam;
    const float Y = q.qyy + q.lam;
    const float W = q.qzz + q.lam;
    const float adjXY = q.qyz * q.qxz - q.qxy * W;
    const float adjXZ = q.qxy * q.qyz - q.qxz * Y;
    const float adjYZ = q.qxy * q.qxz - q.qyz * X;
    const vec3 E = vec3((Y * W - q.qyz * q.qyz) * inside.x + adjXY * inside.y + adjXZ * inside.z,
                        adjXY * inside.x + (X * W - q.qxz * q.qxz) * inside.y + adjYZ * inside.z,
                        adjXZ * inside.x + adjYZ * inside.y + (X * Y - q.qxy * q.qxy) * inside.z);
    // f1, f2, e: a right-handed frame (Duff et al. 2017, "Building an Orthonormal Basis, Revisited"). A
    // rotation about e by half the angle of (de, be) takes f1, f2 to the principal axes e1, e2 of q.
    const float se = E.z < 0.0 ? -1.0 : 1.0;
    const float reach = sqrt(max(length2(E), 1e-36));
    const float stretch = se * reach + E.z;
    const float invE = 1.0 / (reach * stretch);
    ConeAxes o;
    o.e = E * (stretch * invE);
    const float fb = -E.x * E.y * invE;
    const vec3 f1 = vec3(1.0 - se * E.x * E.x * invE, se * fb, -se * o.e.x);
    const vec3 f2 = vec3(fb, se - E.y * E.y * invE, -o.e.y);
    const vec3 qf1 = vec3(q.qxx * f1.x + q.qxy * f1.y + q.qxz * f1.z,
                          q.qxy * f1.x + q.qyy * f1.y + q.qyz * f1.z,
                          q.qxz * f1.x + q.qyz * f1.y + q.qzz * f1.z);
    const float S = 0.5 * (q.tr + q.lam);
    const float de = dot(f1, qf1) - S;
    const float be = dot(f2, qf1);
    const float ade = abs(de) + 1e-15; // a circular cone has r = 0, and any axes will do
    const float r = sqrt(ade * ade + be * be);
    // S is the mean of the two positive eigenvalues. If both are far smaller than lam, rounding may
    // take the larger one below 0. The limit is far below the rounding of lam itself (6e-8 lam).
    const float l1 = max(S + r, 1e-9 * q.lam);
    const float invLD = 1.0 / (l1 * q.D0);
    o.A2 = q.lam * q.D0 * invLD;                       // lam / l1
    o.B2 = max(q.lam * q.lam * l1 * l1 * invLD, o.A2); // lam / l2, where l1 l2 = D0 / lam
    const float turn = inversesqrt(2.0 * r * (r + ade));
    const float ph = (r + ade) * turn;
    const float qh = be * turn;
    const float cosT = de >= 0.0 ? ph : abs(qh);
    const float sinT = de >= 0.0 ? qh : (be < 0.0 ? -ph : ph);
    const vec3 e1 = cosT * f1 + sinT * f2;
    o.e2 = cosT * f2 - sinT * f1;
    // For a narrow lobe the cone is flat, and rounding relative to the length of e1 is not small beside
    // the cone's thickness. The matrix q + lam I maps e to 0 and e1 to a multiple of itself: that takes
    // out what e1 has of e, and makes its small components precise too.
    const vec3 scaled = vec3(X * e1.x + q.qxy * e1.y + q.qxz * e1.z,
                             q.qxy * e1.x + Y * e1.y + q.qyz * e1.z,
                             q.qxz * e1.x + q.qyz * e1.y + W * e1.z);
    const float length2Scaled = length2(scaled);
    o.e1 = length2Scaled > MIN_LENGTH2 ? scaled * inversesqrt(length2Scaled) : e1;
    return o;
}

// Returns the rim's part of 2 pi Phi. On the rim, w^T q w = 0. In the principal axes e1, e2, e of q (e
// is the axis of the cone, a and b are the tangents of its half angles along e1 and e2) the rim is
// w = (a cos t, b sin t, 1), so |w|^2 = 1 + a^2 cos^2 t + b^2 sin^2 t and
// w x dw = (-b cos t, -a sin t, a b) dt. The three integrals are an arc tangent, an inverse hyperbolic
// tangent and an arc tangent of values at the ends. wc is w at the middle of the chord between the
// ends, sp is half the chord's length, and `above` tells whether the cap's centre is above the horizon.
vec3 capArc(ConeAxes axes, float sg, vec3 wc, float sp, bool above)
{
    const float a = sqrt(axes.A2);
    const float b = sqrt(axes.B2);
    // The ends of the rim's arc: (cos t, sin t) scaled to vectors of the lengths lp and lm.
    const float w1 = dot(wc, axes.e1);
    const float w2e = dot(wc, axes.e2);
    const vec2 plus = vec2((w1 + sp * axes.e1.y) * b, (w2e + sp * axes.e2.y) * a);
    const vec2 minus = vec2((w1 - sp * axes.e1.y) * b, (w2e - sp * axes.e2.y) * a);
    // The lengths are a b w . e, too. Where the cone is narrow and flat, and its arc cancels against
    // the horizon, this keeps rounding of the cone's thickness out of the angles of the ends. In wide
    // cones w . e may be small beside w.
    const bool isNarrow = axes.B2 < 1.0;
    const float we = dot(wc, axes.e);
    const float lp = max(isNarrow ? a * b * (we + sp * axes.e.y) : sqrt(dot(plus, plus)), 1e-18);
    const float lm = max(isNarrow ? a * b * (we - sp * axes.e.y) : sqrt(dot(minus, minus)), 1e-18);
    const float oa = 1.0 + axes.A2;
    const float ob = 1.0 + axes.B2;
    const float oab = oa * ob;
    const float soab = sqrt(oab);
    const float df = max(axes.B2 - axes.A2, 1e-6 * ob);
    const float inv = 1.0 / (oab * df);
    const float invSoab = soab * df * inv;
    const float g2 = df * df * ob * inv; // df / oa
    const float g = sqrt(g2);
    const float h = g * oa * invSoab; // sqrt(df / ob)
    const float co = oa * plus.x * minus.x + ob * plus.y * minus.y;
    const float si = sg * soab * (plus.x * minus.y - minus.x * plus.y);
    const float lpm = lp * lm;
    const vec2 angles = atan2Pair(vec2(si, g * (minus.y * lp - plus.y * lm)),
                                  vec2(co, lpm + g2 * plus.y * minus.y));
    const float angle = angles.x;
    // The arc from one end to the other is `angle` or the rest of the full turn. If it is nearly empty
    // or nearly full (within atan(1 / 7) = 8 degrees), rounding could confuse the two, so the side of
    // the horizon on which the centre lies decides.
    const bool full = co > 7.0 * abs(si) ? above : angle < 0.0;
    const float dt = full ? angle + 2.0 * PI : angle;
    return axes.e1 * (-b * g * oab * inv * angles.y) +
           axes.e2 * (a * h * oab * inv *
                      atanhRatio(h * (minus.x * lp - plus.x * lm), lpm - h * h * plus.x * minus.x)) +
           axes.e * (sg * a * b * dt * invSoab);
}

// Returns the region of the part above the horizon of a cap that crosses it, |NoC| < s.
ConicRegion clippedCap(ConicPoint p, SphereCap cap, CapFrame f)
{
    // The horizon comes first because it does not need the root that makeCapCone computes, so that two
    // long chains of operations can overlap.
    const Chord chord = makeChord(cap, f.sinC);
    const vec3 horizon = horizonArc(p, f, chord);
    const CapCone cone = makeCapCone(p, cap, f);
    // w at the middle of the chord between the ends of the arcs: it lies inside the cone.
    const vec3 wc = vec3(1.0 + f.v1 - chord.cm, f.v2, p.alpha * p.NoV);
    const vec3 arc = capArc(makeConeAxes(cone, wc), cone.sg, wc, chord.sp, cap.NoC > 0.0);
    const float phiZ = (arc.z + horizon.z) * (0.5 * INV_PI);
    const vec2 slope = (arc.xy + horizon.xy) * (0.5 * INV_PI * p.alpha / max(phiZ, 1e-12));
    ConicRegion o;
    o.integral = saturate(phiZ);
    o.av = f.v1 * slope.x + f.v2 * slope.y;
    o.x2 = dot(slope, slope);
    o.mu = max(p.NoV + o.av, MIN_CONIC_MU);
    return o;
}

// A whole cap that replaces the visible part of a cap too small to be clipped (SMALL_CAP).
struct SubstituteCap {
    vec3 c;
    float NoC, s2, omc;
};

// Returns the substitute: it has the area and the centroid of the visible part, a segment of a circle.
SubstituteCap substituteCap(ConicPoint p, SphereCap cap)
{
    const float sinC = sqrt(max(1.0 - cap.NoC * cap.NoC, 0.0));
    const float mean = capHeights(cap, sinC).mean;
    SubstituteCap o;
    o.c = cap.c + p.n * (mean - cap.NoC);
    o.c *= inversesqrt(max(length2(o.c), MIN_LENGTH2));
    o.NoC = dot(p.n, o.c);
    // u is the share of the cap's diameter above the horizon. The polynomial gives the share of its
    // area (shared/conic_constants.h).
    const float u = saturate(0.5 + 0.5 * cap.NoC / cap.s);
    o.omc = cap.omc * u * sqrt(u) * (CONIC_SEGMENT - u * (CONIC_SEGMENT_U + CONIC_SEGMENT_U2 * u));
    o.s2 = o.omc * (2.0 - o.omc);
    return o;
}

#endif
