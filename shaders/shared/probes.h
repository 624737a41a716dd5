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

// One shading point (at the origin, normal n, eye towards v) and one sphere light.
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

GPU_END

#endif
