// SPDX-License-Identifier: Apache-2.0
// Records that cross between tests/gpu/test_dfg.cpp and probes/dfg.comp.
#ifndef CND_SHARED_DFG_PROBE_H
#define CND_SHARED_DFG_PROBE_H

#include "shared/dfg.h"
#include "shared/probes.h"

GPU_BEGIN

const uint PROBE_TABLE = 2u; // texel buffer

struct DfgProbeInput {
    float NoV, alpha;
    float albedo, F0, F90; // a grey material
    uint joining;          // LOBES_*
    uint energyCompensation;
};
GPU_SIZE(DfgProbeInput, 28)

struct DfgProbeOutput {
    vec2 directionalAlbedo;
    float albedo, F0, F90; // after joining
};
GPU_SIZE(DfgProbeOutput, 20)

GPU_END

#endif
