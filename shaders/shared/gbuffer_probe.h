// SPDX-License-Identifier: Apache-2.0
// Records that cross between tests/gpu/test_gbuffer.cpp and probes/gbuffer_packing.comp.
#ifndef CND_SHARED_GBUFFER_PROBE_H
#define CND_SHARED_GBUFFER_PROBE_H

#include "shared/gbuffer.h"
#include "shared/probes.h"

GPU_BEGIN

struct PackingProbeInput {
    vec3 normal;
    float perceptualRoughness;
};
GPU_SIZE(PackingProbeInput, 16)

// The surface after packing and unpacking.
struct PackingProbeOutput {
    vec3 normalFull;
    float roughnessFull;
    vec3 normalCompact;
    float roughnessCompact;
    vec3 unlit; // unpacked from the unlit code: largest channel of albedo and of F0, weight
};
GPU_SIZE(PackingProbeOutput, 44)

GPU_END

#endif
