// SPDX-License-Identifier: Apache-2.0
// Records that cross between tests/gpu/test_area_lights.cpp and probes/area_lights.comp.
#ifndef CND_SHARED_AREA_PROBE_H
#define CND_SHARED_AREA_PROBE_H

#include "shared/probes.h"

GPU_BEGIN

// One area light. The shaded point is at the origin, its normal is +z, the eye is in the direction
// v.
struct AreaProbeInput {
    uint type;     // LIGHT_SPHERE, LIGHT_TUBE, LIGHT_RECTANGLE or LIGHT_DISC
    uint twoSided; // rectangles and discs
    uint seed;
    float alpha;
    vec3 v;
    vec3 toCentre;
    vec3 axisU; // disc: unit normal
    vec3 axisV;
    float radius;
};
GPU_SIZE(AreaProbeInput, 68)

// Responses with F = 1 and F = (1 - VoH)^5.
struct AreaProbeOutput {
    float formFactor;
    float formFactorAlone; // of an outline that is walked without the specular lobe
    vec2 conic;            // closed form
    vec2 representative;   // 0 for spheres, which have a method of their own
    vec2 sampled;          // AREA_PROBE_SAMPLES samples
};
GPU_SIZE(AreaProbeOutput, 32)
const uint AREA_PROBE_SAMPLES = 256u;

GPU_END

#endif
