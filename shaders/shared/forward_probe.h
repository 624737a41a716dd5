// SPDX-License-Identifier: Apache-2.0
// Data that tests/gpu/test_forward.cpp and probes/forward.comp share. Descriptor set 0 belongs
// to the probe, set 1 to lib/forward.glsl.
#ifndef CND_SHARED_FORWARD_PROBE_H
#define CND_SHARED_FORWARD_PROBE_H

#include "shared/prelude.h"

GPU_BEGIN

const uint FORWARD_PROBE_SET = 1u;
const uint FORWARD_PROBE_NORMAL_ROUGHNESS = 0u;
const uint FORWARD_PROBE_ALBEDO = 1u;
const uint FORWARD_PROBE_SPECULAR = 2u;
const uint FORWARD_PROBE_DEPTH = 3u;
const uint FORWARD_PROBE_OUTPUT = 4u;
const uint FORWARD_PROBE_GROUP = 64u;

struct ForwardProbeOutput {
    vec4 lit;           // litSurface()
    vec4 stepped;       // the same, summed light by light with a cursor
    vec4 illuminance;   // rgb: sum of illuminanceTowards()
    vec4 illuminanceBy; // rgb: sum of illuminanceTowards() times the direction
};
GPU_SIZE(ForwardProbeOutput, 64)

struct ForwardProbeParams {
    uvec2 size;        // pixels
    vec2 invImageSize; // the same bits as in the lighting module
    float clearDepth;
    uint shadowed; // mask: lights whose id has one of these bits have a visibility of 0.5
};
GPU_SIZE(ForwardProbeParams, 24)

GPU_END

#endif
