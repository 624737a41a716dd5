// SPDX-License-Identifier: Apache-2.0
// Layout of the table of linearly transformed cosines (engine/tables/ltc_table.h), made by tools/fit
// and read by shaders/lib/specular/ltc.glsl.
#ifndef CND_SHARED_LTC_H
#define CND_SHARED_LTC_H

#include "shared/prelude.h"

GPU_BEGIN

// Entry (i, j), at index j * LTC_TABLE_SIZE + i:
//   perceptual roughness r = LTC_MIN_ROUGHNESS + (1 - LTC_MIN_ROUGHNESS) i / (LTC_TABLE_SIZE - 1),
//   NoV = LTC_MIN_NOV + (1 - LTC_MIN_NOV) (1 - v^2)^2, v = j / (LTC_TABLE_SIZE - 1): even in the angle
//   near the normal, and dense at grazing, where the lobe changes most.
// An entry is LTC_TEXELS vec4: of the lobe with F = 1, and of that with Schlick's Fresnel between
// LTC_DIELECTRIC_F0 and 1. Each holds sharpness in the plane of incidence, sharpness across it, shift
// (LtcShape of tools/fit says what they are) and directional albedo.
const uint LTC_TABLE_SIZE = 32u;
const uint LTC_TEXELS = 2u;
const float LTC_MIN_ROUGHNESS = 0.0447213595f; // alpha 0.002
const float LTC_DIELECTRIC_F0 = 0.04f;
const float LTC_MIN_NOV = 0.02f;

GPU_END

#endif
