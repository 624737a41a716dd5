// SPDX-License-Identifier: Apache-2.0
// Records that cross between tests/gpu/test_gbuffer.cpp and probes/gbuffer_packing.comp.
#ifndef CND_SHARED_GBUFFER_PROBE_H
#define CND_SHARED_GBUFFER_PROBE_H

#include "shared/gbuffer_data.h"
#include "shared/probes.h"

GPU_BEGIN

struct PackingProbeInput {
    vec3 normal;
    float perceptualRoughness;
    vec3 albedo;
    float specularWeight;
    vec3 F0;
};
GPU_SIZE(PackingProbeInput, 44)

// The surface after packing and unpacking, and the packed words of layout FULL.
struct PackingProbeOutput {
    uvec2 normalRoughness, albedo, specular;
    vec3 normalFull;
    float roughnessFull;
    vec3 albedoFull;
    float weightFull;
    vec3 F0Full;
    vec3 normalCompact;
    float roughnessCompact;
    vec3 unlit; // unpacked from the unlit code: largest channel of albedo and of F0, weight
};
GPU_SIZE(PackingProbeOutput, 96)

GPU_END

#endif
