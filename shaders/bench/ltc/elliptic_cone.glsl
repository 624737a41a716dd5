// SPDX-License-Identifier: Apache-2.0
// The form factor of an ellipse, from the vector irradiance of the elliptic cone that it is seen under.
#ifndef CND_BENCH_LTC_ELLIPTIC_CONE
#define CND_BENCH_LTC_ELLIPTIC_CONE

#include "lib/lights/sphere.glsl"

// The cone of the directions to the ellipse c + u cos(t) + v sin(t), given by its dual quadratic form
// u u^T + v v^T - c c^T. The form has one negative eigenvalue, -mu, whose eigenvector e is the cone's
// axis, and two positive eigenvalues, nu1 and nu2.
struct DualCone {
    float xx, yy, zz, xy, xz, yz;
    float trace;
    float minors;      // sum of the principal 2 x 2 minors
    float determinant; // mu nu1 nu2 = det(u, v, c)^2
};

// Returns the root mu of (t - mu)(t + nu1)(t + nu2) = t^3 + trace t^2 + minors t - determinant, where
// 0 < mu <= |c|^2. It starts from an upper bound of mu. From there Halley's iteration (1694) on a
// polynomial whose roots are all real comes down without overshooting.
float dualConeRoot(DualCone k, float c2)
{
    // An upper bound, because t^3 >= 0 implies trace t^2 + minors t <= determinant at the root.
    const float fromQuadratic = 2.0 * k.determinant /
        max(k.minors + sqrt(max(k.minors * k.minors + 4.0 * k.trace * k.determinant, 0.0)), 1e-37);
    float mu = k.trace > 0.0 ? min(c2, fromQuadratic) : c2;
    for (int i = 0; i < 4; ++i) {
        const float f = ((mu + k.trace) * mu + k.minors) * mu - k.determinant;
        const float f1 = (3.0 * mu + 2.0 * k.trace) * mu + k.minors;
        const float denominator = f1 * f1 - f * (3.0 * mu + k.trace);
        mu -= denominator > 0.0 ? max(f * f1 / denominator, 0.0) : 0.0;
    }
    // At the centre of the ellipse c2 is 0. The caller divides by the root, so 0 is never returned.
    return max(mu, max(1e-12 * c2, MIN_LENGTH2));
}

// Returns the form factor of the cone around the direction c (to the ellipse's centre) for a receiver
// with the normal z, whose horizon is the plane z = 0. The vector irradiance, which has the direction e
// and the length |Phi| = sqrt(nu1 nu2 / ((mu + nu1)(mu + nu2))), is exact, and so is the result for a
// cone wholly above the horizon. A cone that crosses the horizon is replaced by the circular cone of
// the same |Phi| (an idea of Hill and Heitz 2016, "Real-time area lighting: a journey from research to
// production"), whose elevation is scaled so that it is cut when the ellipse itself is cut: if S is the
// sine of the ellipse's half width across the horizon, e.z / S runs from -1 to 1 as the ellipse rises.
// The result is exact for circular cones and, in the limit, for small ones. It is 0 exactly when the
// whole ellipse is below the horizon.
float ellipticConeFormFactor(DualCone k, vec3 c)
{
    const float mu = dualConeRoot(k, length2(c));
    const float p = max((3.0 * mu + 2.0 * k.trace) * mu + k.minors, 1e-37);
    const float phi = min(sqrt(k.determinant / (mu * p)), 1.0);
    const float x = k.xx + mu;
    const float y = k.yy + mu;
    const float z = k.zz + mu;
    const float axy = k.yz * k.xz - k.xy * z; // an element of the adjugate, which is p e e^T
    const float axz = k.xy * k.yz - k.xz * y;
    const float ayz = k.xy * k.xz - k.yz * x;
    const vec3 e = vec3((y * z - k.yz * k.yz) * c.x + axy * c.y + axz * c.z,
                        axy * c.x + (x * z - k.xz * k.xz) * c.y + ayz * c.z,
                        axz * c.x + ayz * c.y + (x * y - k.xy * k.xy) * c.z);
    const float cosine = clamp(e.z * inversesqrt(max(length2(e), 1e-37)), -1.0, 1.0);
    const float rho = k.zz / mu; // > 0: the cone crosses the horizon
    const float S = sqrt((max(rho, 0.0) + cosine * cosine) / (1.0 + max(rho, 0.0)));
    const float s = sqrt(phi);
    const float crossing = sphereFormFactor(s * clamp(cosine / max(S, 1e-12), -1.0, 1.0), phi) * S;
    const float whole = c.z > 0.0 ? phi * max(cosine, 0.0) : 0.0;
    return min(rho > 0.0 ? crossing / max(s, 1e-12) : whole, 1.0);
}

#endif
