// SPDX-License-Identifier: Apache-2.0
// The table of the specular lobe's directional albedo, and the ways to join the lobes that it
// serves.
#ifndef CND_SHARED_DFG_H
#define CND_SHARED_DFG_H

#include "shared/prelude.h"

GPU_BEGIN

// A side of the table. Rows: alpha = y^4, from y = MIN_ALPHA^(1/4) to 1; columns: NoV = x^4, from
// x = MIN_NOV^(1/4) to 1. The lobe changes where NoV is about alpha, so both axes crowd towards 0;
// with square roots in place of fourth roots the error is 6 times as large. 96: bilinear
// interpolation errs by at most 7e-4 (measured by tests/gpu/test_dfg.cpp), 64: by 1.2e-3.
const uint DFG_SIZE = 96u;
// Largest error of a looked-up value, alpha 0.002..1, NoV 1e-4..1.
const float DFG_ERROR = 1e-3f;

// --- dfg_table: one lane per entry. An entry is a vec4: A and B of its column, then of the next,
// so that a bilinear look-up is two loads.
//   A, B: share of the light from a white surrounding that the lobe reflects with F = 1 and with
//   F = (1 - VoH)^5; with Schlick's Fresnel it is F0 (A - B) + F90 B.
const uint DFG_TABLE_GROUP = 64u;
const uint DFG_TABLE_ENTRIES = 0u;
// Midpoint rule over the visible normals: rings of equal steps in the cube root of the uncovered
// area (the lobe's tail lies there), spokes over half a turn. Quadrature error 2.4e-4.
const uint DFG_RINGS = 64u;
const uint DFG_SPOKES = 48u;
struct DfgTableParams {
    uint entryCount; // DFG_SIZE^2
};
GPU_SIZE(DfgTableParams, 4)

// CndLobeJoining.
const uint LOBES_CONSERVING = 0u;
const uint LOBES_SUM = 1u;

GPU_END

#endif
