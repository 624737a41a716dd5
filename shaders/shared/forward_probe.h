// SPDX-License-Identifier: Apache-2.0
// What crosses between tests/gpu/test_forward.cpp and probes/forward.comp. Set 0 is the probe's,
// set 1 that of lib/forward.glsl.
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
    vec4 stepped;       // the same light by light
    vec4 illuminance;   // rgb: sum of illuminanceTowards()
    vec4 illuminanceBy; // rgb: the same, times the directions
};
GPU_SIZE(ForwardProbeOutput, 64)

struct ForwardProbeParams {
    uvec2 size;        // pixels
    vec2 invImageSize; // bit for bit that of the module
    float clearDepth;
    uint shadowed; // mask: of lights whose id has one of its bits a half is seen
};
GPU_SIZE(ForwardProbeParams, 24)

GPU_END

#endif
