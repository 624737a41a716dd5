// SPDX-License-Identifier: Apache-2.0
// Sampling of the GGX distribution, in a frame whose z axis is the surface normal.
#ifndef CND_LIB_GGX_SAMPLING
#define CND_LIB_GGX_SAMPLING

#include "lib/math.glsl"

// Returns Smith's Lambda (Heitz 2014, eq. 72), for 0 < cosTheta <= 1.
float smithLambda(float cosTheta, float alpha)
{
    const float c2 = cosTheta * cosTheta;
    const float tan2 = max(1.0 - c2, 0.0) / c2;
    return 0.5 * sqrt(1.0 + alpha * alpha * tan2) - 0.5;
}

// Returns a unit microfacet normal from the distribution of the normals visible from v, for phi uniform
// over a full turn and u uniform in [0, 1] (Dupuy and Benyoub 2023, "Sampling Visible GGX Normals with
// Spherical Caps").
vec3 visibleNormal(vec3 v, float alpha, float phi, float u)
{
    const vec3 stretched = normalize(vec3(alpha * v.xy, v.z));
    const float z = (1.0 - u) * (1.0 + stretched.z) - stretched.z;
    const float sine = sqrt(saturate(1.0 - z * z));
    const vec3 h = vec3(sine * cos(phi), sine * sin(phi), z) + stretched;
    return normalize(vec3(alpha * h.xy, max(h.z, 0.0)));
}

#endif
