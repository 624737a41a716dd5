// SPDX-License-Identifier: Apache-2.0
// The cap of directions under which a sphere is seen, near or distant. Every specular method of sphere
// lights starts from it.
#ifndef CND_LIB_LIGHTS_SPHERE_CAP
#define CND_LIB_LIGHTS_SPHERE_CAP

#include "lib/math.glsl"

struct SphereCap {
    vec3 c;    // unit direction to the centre
    float NoC; // n . c
    float s2;  // sin^2 of the cap's half angle, (R / d)^2 in [0, 1], for the form factor
    // For specular responses, from s2 clamped to MAX_SPECULAR_S2:
    float s;   // sine of the half angle
    float omc; // 1 - cosine of the half angle
};

// The largest s2 of specular responses. At 1, where the cap is a hemisphere, 1 / cos of the half angle
// would be infinite. A receiver on or inside the sphere sees a cap with this s2, whose half angle is
// 89.4 degrees.
const float MAX_SPECULAR_S2 = 0.9999;

// `toLight`: from the receiver to the centre; `radius`: in the same unit. For a distant sphere they are
// its unit direction and the sine of its angular radius. For a receiver exactly at the centre the cap
// lies around n.
SphereCap makeSphereCap(vec3 n, vec3 toLight, float radius)
{
    SphereCap cap;
    // The additions are below the rounding of any |toLight| above 1e-7.
    const vec3 t = toLight + 1e-15 * n;
    const float invD = inversesqrt(length2(t) + 1e-32);
    cap.c = t * invD;
    cap.NoC = dot(n, cap.c);
    const float s = min(radius * invD, 1.0);
    cap.s2 = s * s;
    const float specularS2 = min(cap.s2, MAX_SPECULAR_S2);
    cap.s = min(s, 0.99995); // sqrt(MAX_SPECULAR_S2)
    cap.omc = specularS2 / (1.0 + sqrt(1.0 - specularS2)); // 1 - sqrt(1 - s2) without cancellation
    return cap;
}

#endif
