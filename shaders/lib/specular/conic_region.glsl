// SPDX-License-Identifier: Apache-2.0
// A sphere light under the GGX lobe, without shadowing and Fresnel: exact, no table, no fit.
//
// Let m = (x, y, 1) be the slope of the half vector about the normal. The light's cap is one conic in
// slopes, m^T Q m <= 0 with Q = k I - (v c^T + c v^T), k = cos(half angle) + v . c; and D (n . h) dw_h
// = p22 dx dy is, stretched by 1 / alpha, the clamped cosine (Heitz, Dupuy, Hill and Neubelt 2016 use
// the same fact). So the integral of D (n . h) over the cap is the irradiance of an elliptic cone, and
// the mean slope over it is the direction of that cone's vector irradiance. With q the stretched Q,
// eigenvalues l1, l2 > 0 > -lam:
//   |Phi| = lam / sqrt((l1 + lam) (l2 + lam)), along the eigenvector of -lam,
// and lam is the one positive root of p(t) = t^3 + tr t^2 + m2 t - D0, the characteristic polynomial.
#ifndef CND_LIB_SPECULAR_CONIC_REGION
#define CND_LIB_SPECULAR_CONIC_REGION

#include "lib/brdf.glsl"
#include "lib/lights/sphere_cap.glsl"

// What does not depend on the light.
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

// Below this the mean slope exceeds what float32 resolves. v is tilted with it: with only the number
// clamped, v . n and NoV disagree and the conic is none.
const float MIN_CONIC_NOV = 0.02;

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

// The lobe over the light.
struct ConicRegion {
    float integral; // of D (n . h) over the half vectors that reflect the eye to the light, 0..1
    float x2;       // squared length of the mean slope there
    float av;       // mean slope . v
    float mu;       // NoV + av = v . (mean slope, 1) > 0
};

// Smallest v . mean: rounding can bring it to zero and below.
const float MIN_CONIC_MU = 1e-6;

// One step of Halley's iteration on p(t): from above the root it converges monotonically, because all
// roots of p are real. Rounding can take a step below zero; what it is replaced with is relative to t,
// because the root falls with the light's area, without end.
float halley(float t, float tr, float m2, float D0)
{
    const float f2 = 3.0 * t + tr;
    const float f = ((t + tr) * t + m2) * t - D0;
    const float f1 = (f2 + tr) * t + m2;
    return max(t - f * f1 / (f1 * f1 - f * f2), 1e-7 * t);
}

// The region of a whole cap. c: unit direction to its centre, s2, omc: sin^2 and 1 - cos of its half
// angle. The cap should not reach below the horizon.
ConicRegion wholeCap(ConicPoint p, vec3 c, float NoC, float s2, float omc)
{
    const vec3 dl = c - p.mirror;
    const float dz = NoC - p.NoV;
    const float t = dot(p.v, c) - p.NoV * NoC; // v_t . c_t, the parts in the surface
    const float ll = 1.0 - NoC * NoC;          // |c_t|^2
    const float w = dot(p.vxn, c);             // v_t x c_t
    const float hh = 0.5 * length2(p.v + c);   // 1 + v . c without cancellation
    const float k = max(hh - omc, 0.001 * hh); // the cap must not hold -v
    const float z0 = 0.5 * length2(dl) - omc;  // cos(half angle) - mirror . c, without cancellation
    // Squared length of NoC v_t + NoV c_t, how far the ellipse lies off the slope origin.
    const float G = max(length2(p.NoV * dl - dz * p.mirror), 1e-14);
    const float AC = 2.0 * (k - t);
    const float M = k * (k - 2.0 * t) - w * w;
    const float ks = k * s2;
    const float Z = z0 * p.invA2;
    const float D0 = ks * p.invA2;
    const float tr = AC + Z;
    const float m2 = M + AC * Z - G * p.invA2;
    // Start: the root if the ellipse's axis pointed at the origin; an upper bound otherwise.
    const float u = clamp(M * z0 + ks, 1e-4 * AC * G, AC * G);
    const float inside = max(0.0, -Z);
    const float invU = 1.0 / (u + inside * G);
    const float ka = max(M * G + (AC * G - u) * inside, 0.001 * u * AC) * invU;
    const float c0 = Z >= 0.0 ? D0 * G * invU : G * p.invA2 - Z * ka;
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
