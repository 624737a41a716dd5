// SPDX-License-Identifier: Apache-2.0
// The table of the specular lobe's directional albedo, and the ways to join the diffuse and the
// specular lobe, which use it.
#ifndef CND_SHARED_DFG_H
#define CND_SHARED_DFG_H

#include "shared/prelude.h"

GPU_BEGIN

// The number of rows and of columns. Row: alpha = y^4, from y = MIN_ALPHA^(1/4) to 1; column:
// NoV = x^4, from x = MIN_NOV^(1/4) to 1. The lobe changes most where NoV is about alpha, so both
// axes are denser towards 0; with square roots in place of fourth roots the error is 6 times as
// large. With 96 rows the error of bilinear interpolation is at most 7e-4 (measured by
// tests/gpu/test_dfg.cpp), with 64 it is 1.2e-3.
const uint DFG_SIZE = 96u;
// Largest error of an interpolated value, for alpha 0.002..1 and NoV 1e-4..1.
const float DFG_ERROR = 1e-3f;

// --- dfg_table: one lane per entry. An entry is a vec4 with A and B of its column and of the next
// column, so that a bilinear look-up needs two loads. A and B are the shares of a uniform white
// environment's light that the lobe reflects with F = 1 and with F = (1 - VoH)^5. With Schlick's
// Fresnel term the share is F0 (A - B) + F90 B.
const uint DFG_TABLE_GROUP = 64u;
const uint DFG_TABLE_ENTRIES = 0u;
// The integral over the visible normals is computed by the midpoint rule: over rings, with equal
// steps in the cube root of the area outside the ring (which holds the lobe's tail), and over
// spokes of half a turn. The quadrature error is 2.4e-4.
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
