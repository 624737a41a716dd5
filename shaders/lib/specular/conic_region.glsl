// SPDX-License-Identifier: Apache-2.0
// The integral of a GGX lobe over a sphere light, before shadowing and Fresnel. It is exact, without a
// table or a fit. The sphere is seen as a cap of directions with the half angle S around the unit
// vector c; n is the surface's unit normal, v the unit vector to the eye.
//
// 1. Half vectors are written as slopes, m = h / (n . h) = (x, y, 1) in a frame with n as z. Such a
//    half vector reflects the eye to the light direction l = 2 (v . m) m / (m . m) - v.
// 2. The cap is l . c >= cos S. With l from step 1 and times m . m, this is a conic in slopes:
//      m^T Q m <= 0,   Q = k I - (v c^T + c v^T),   k = cos S + v . c.
// 3. The lobe D (n . h) dw_h is, in slopes, alpha^2 / (pi (alpha^2 + x^2 + y^2)^2) dx dy (Trowbridge
//    and Reitz 1975). As a function of the direction of w = (x / alpha, y / alpha, 1) that is the
//    clamped cosine, (1 / pi) (n . w / |w|) dw. Heitz, Dupuy, Hill and Neubelt 2016 use the same fact.
// 4. So the lobe's integral over the cap is the irradiance, divided by pi, that the surface gets from a
//    cone of luminance 1, w^T q w <= 0 with q = T Q T / alpha^2, T = diag(alpha, alpha, 1). The vector
//    irradiance Phi = (1 / pi) (integral of the unit vectors in the cone) gives it for all normals. The
//    lobe's integral is Phi_z, and the mean slope over lobe and cap is alpha (Phi_x, Phi_y) / Phi_z,
//    because slopes are alpha (w_x, w_y) / w_z.
// 5. By symmetry Phi lies along the cone's axis. Let l1, l2 > 0 > -lam be the eigenvalues of q. The
//    tangents of the cone's half angles are A = sqrt(lam / l1) and B = sqrt(lam / l2). For a receiver
//    that faces along the axis its form factor is A B / sqrt((1 + A^2) (1 + B^2)), so
//      |Phi| = lam / sqrt((l1 + lam) (l2 + lam)).
// 6. lam is the one positive root of p(t) = det(q + t I) = t^3 + tr t^2 + m2 t - D0: tr is the trace of
//    q, m2 the sum of its principal 2x2 minors, and D0 = -det q = k sin^2 S / alpha^2. P = p'(lam) is
//    (l1 + lam) (l2 + lam), and the adjugate of q + lam I is P e e^T with the unit vector e along the
//    axis. So Phi_z = lam sqrt(adj) / P, with the adjugate's last entry adj, and the mean slope follows
//    from its last column: no eigenvector is computed.
//
// The code is written in dot products, without a frame. v_t and c_t stand for the components of v and c
// in the plane of the surface. Small numbers in max() and clamp() keep rounding from making a divisor
// or the argument of a root zero or negative; none of them is fitted.
#ifndef CND_LIB_SPECULAR_CONIC_REGION
#define CND_LIB_SPECULAR_CONIC_REGION

#include "lib/brdf.glsl"
#include "lib/lights/sphere_cap.glsl"
#include "shared/conic_constants.h"

// The terms that do not depend on the light.
struct ConicPoint {
    vec3 n;
    vec3 v;      // to the eye, tilted up to NoV >= MIN_CONIC_NOV
    vec3 mirror; // v reflected about n
    vec3 vxn;    // v x n
    float NoV;
    float vv;    // 1 - NoV^2, squared length of v's tangential part
    float alpha, a2, oneMinusA2, invA2;
    float smithV; // sqrt(a2 + (1 - a2) NoV^2)
};

ConicPoint makeConicPoint(ShadingPoint s)
{
    ConicPoint p;
    p.n = s.n;
    const float NoV = dot(s.n, s.v);
    p.NoV = max(NoV, MIN_CONIC_NOV);
    const vec3 tangent = s.v - NoV * s.n;
    const vec3 tilted = MIN_CONIC_NOV * s.n +
        sqrt(1.0 - MIN_CONIC_NOV * MIN_CONIC_NOV) * inversesqrt(max(length2(tangent), 1e-12)) * tangent;
    p.v = NoV < MIN_CONIC_NOV ? tilted : s.v;
    p.mirror = 2.0 * p.NoV * s.n - p.v;
    p.vxn = cross(p.v, s.n);
    p.vv = length2(p.vxn);
    p.alpha = s.alpha;
    p.a2 = s.alpha * s.alpha;
    p.oneMinusA2 = 1.0 - p.a2;
    p.invA2 = 1.0 / p.a2;
    p.smithV = sqrt(p.a2 + p.oneMinusA2 * p.NoV * p.NoV);
    return p;
}

// The lobe over a light: its integral and its mean slope.
struct ConicRegion {
    float integral; // of D (n . h), over the half vectors that reflect the eye to the light; 0..1
    float x2;       // squared length of the mean slope of these half vectors
    float av;       // mean slope . v
    float mu;       // NoV + av = v . (mean slope, 1) > 0
};

// Returns the result of one step of Halley's iteration on p(t), t - p p' / (p'^2 - p p'' / 2). From
// above the root it converges monotonically, because all roots of p are real. Rounding can take a step
// below zero. The lower limit is relative to t, because the root goes to zero with the light's area.
float halley(float t, float tr, float m2, float D0)
{
    const float f2 = 3.0 * t + tr;
    const float f = ((t + tr) * t + m2) * t - D0;
    const float f1 = (f2 + tr) * t + m2;
    return max(t - f * f1 / (f1 * f1 - f * f2), 1e-7 * t);
}

// Returns the region of a whole cap. `c`: unit direction to its centre; `s2`, `omc`: sin^2 and 1 - cos
// of its half angle. The cap should not reach below the horizon.
//
// q consists of a 2x2 block in the plane of the surface, k I - (v_t c_t^T + c_t v_t^T), with the trace
// AC and the determinant M; of a column -(NoC v_t + NoV c_t) / alpha, with the squared length
// G / alpha^2; and of the corner Z = (cos S - mirror . c) / alpha^2. Then tr = AC + Z and
// m2 = M + AC Z - G / alpha^2.
//
// The iteration starts above the root. Let along, across and mixed be the block's entries in a frame
// whose first axis is the direction of the column (across = u / G). Then p(t) = 0 reads
//   (t + ka) (t + Z) = G / alpha^2,   ka = along - mixed^2 / (t + across).
// The root is at least inside = max(0, -Z), and ka grows with t. So with ka taken at t = inside, the
// root of the quadratic is an upper bound, and the root itself if mixed is 0.
ConicRegion wholeCap(ConicPoint p, vec3 c, float NoC, float s2, float omc)
{
    const vec3 dl = c - p.mirror;
    const float dz = NoC - p.NoV;
    const float t = dot(p.v, c) - p.NoV * NoC; // v_t . c_t
    const float ll = 1.0 - NoC * NoC;          // |c_t|^2
    const float w = dot(p.vxn, c);             // v_t x c_t
    const float hh = 0.5 * length2(p.v + c);   // 1 + v . c without cancellation
    const float k = max(hh - omc, 0.001 * hh); // positive: the cap must not hold -v
    const float z0 = 0.5 * length2(dl) - omc;  // cos(half angle) - mirror . c, without cancellation
    // Squared length of NoC v_t + NoV c_t. It is 0 if the ellipse is centred on slope 0.
    const float G = max(length2(p.NoV * dl - dz * p.mirror), 1e-14);
    const float AC = 2.0 * (k - t);
    const float M = k * (k - 2.0 * t) - w * w;
    const float ks = k * s2;
    const float Z = z0 * p.invA2;
    const float D0 = ks * p.invA2;
    const float tr = AC + Z;
    const float m2 = M + AC * Z - G * p.invA2;
    const float u = clamp(M * z0 + ks, 1e-4 * AC * G, AC * G);
    const float inside = max(0.0, -Z);
    const float invU = 1.0 / (u + inside * G);
    const float ka = max(M * G + (AC * G - u) * inside, 0.001 * u * AC) * invU;
    const float c0 = Z >= 0.0 ? D0 * G * invU : G * p.invA2 - Z * ka; // without cancellation
    const float b = 0.5 * (Z + ka);
    const float r = sqrt(b * b + c0);
    float lam = b > 0.0 ? c0 / (b + r) : r - b;
    lam = halley(lam, tr, m2, D0);
    lam = halley(lam, tr, m2, D0);

    const float P = max((3.0 * lam + 2.0 * tr) * lam + m2, 1e-20); // (l1 + lam) (l2 + lam)
    const float kp = k + lam;
    const float kt = kp - t;
    const float adj = max(kt * kt - p.vv * ll, 1e-4 * kp * kp);
    const float invAdj = 1.0 / adj;
    // The mean slope x is along the cone's axis, which q + lam I maps to zero:
    // (block + lam) x = NoC v_t + NoV c_t.
    const float a = (kt * NoC + ll * p.NoV) * invAdj; // mean slope = a v_t + e c_t
    const float e = (kt * p.NoV + p.vv * NoC) * invAdj;
    ConicRegion o;
    o.integral = min(lam * sqrt(adj) / P, 1.0);
    o.av = a * p.vv + e * t;
    o.x2 = max(a * (o.av + e * t) + e * e * ll, 0.0);
    o.mu = max(p.NoV + o.av, MIN_CONIC_MU);
    return o;
}

#endif
