// SPDX-License-Identifier: Apache-2.0
// Records that cross between tests and their probe kernels (shaders/probes).
#ifndef CND_SHARED_PROBES_H
#define CND_SHARED_PROBES_H

#include "shared/prelude.h"

GPU_BEGIN

const uint PROBE_GROUP = 64u;
const uint PROBE_INPUT = 0u;
const uint PROBE_OUTPUT = 1u;
struct ProbeParams {
    uint count;
};
GPU_SIZE(ProbeParams, 4)

// One shaded point (at the origin, with the normal n and the eye in the direction v) and one sphere
// light.
struct SphereProbeInput {
    vec3 n;
    vec3 v;
    vec3 centre;
    float radius;
    float alpha;
    float c, s2; // arguments of sphereFormFactor, independent of the rest
};
GPU_SIZE(SphereProbeInput, 52)

struct SphereProbeOutput {
    float formFactor;
    float a, b; // specular response with F = 1 and F = (1 - VoH)^5
};
GPU_SIZE(SphereProbeOutput, 12)

// The results of the functions of lib/portable_math.glsl for a positive float.
struct PortableProbeOutput {
    float reciprocal, inverseSqrt, root;
};
GPU_SIZE(PortableProbeOutput, 12)

// The specular response to a sphere light with its centre at toLight. The shaded point is at the
// origin, its normal is +z, the eye is in the direction v.
struct ConicProbeInput {
    vec3 v;
    vec3 toLight;
    float radius;
    float alpha;
};
GPU_SIZE(ConicProbeInput, 32)

struct ConicProbeOutput {
    uint way;      // EVALUATE_* of shared/bench.h
    vec2 response; // with F = 1 and F = (1 - VoH)^5
};
GPU_SIZE(ConicProbeOutput, 12)

GPU_END

#endif
