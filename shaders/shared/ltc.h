// SPDX-License-Identifier: Apache-2.0
// Layout of the table of linearly transformed cosines
// (tools/candelabra/measure/kernels/ltc_table.inc), which shaders/bench/ltc/lobes.glsl reads.
#ifndef CND_SHARED_LTC_H
#define CND_SHARED_LTC_H

#include "shared/prelude.h"

GPU_BEGIN

// Entry (i, j), at index j * LTC_TABLE_SIZE + i:
//   perceptual roughness r = LTC_MIN_ROUGHNESS + (1 - LTC_MIN_ROUGHNESS) i / (LTC_TABLE_SIZE - 1),
//   NoV = LTC_MIN_NOV + (1 - LTC_MIN_NOV) (1 - v^2)^2, v = j / (LTC_TABLE_SIZE - 1).
// Near the normal the steps of j are uniform in the angle; at grazing angles, where the lobe
// changes most, they are small. An entry is LTC_TEXELS vec4. The first is of the lobe with F = 1:
// the sharpness in the plane of incidence, the sharpness across it, the shift, and the directional
// albedo. In the frame x (in the plane of incidence, perpendicular to the mirror direction), y
// (across the plane), m (the mirror direction), the map turns a direction l into
//   (sharpnessX / alpha) l.x + shift l.m,   (sharpnessY / alpha) l.y,   l.n.
// The second holds in x the directional albedo with Schlick's Fresnel term between
// LTC_DIELECTRIC_F0 and 1.
const uint LTC_TABLE_SIZE = 32u;
const uint LTC_TEXELS = 2u;
const float LTC_MIN_ROUGHNESS = 0.0447213595f; // alpha 0.002
const float LTC_DIELECTRIC_F0 = 0.04f;
const float LTC_MIN_NOV = 0.02f;

GPU_END

#endif
