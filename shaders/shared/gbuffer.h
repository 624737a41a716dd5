// SPDX-License-Identifier: Apache-2.0
// G-buffer packing: field widths and the declared error bounds that tests/gpu/test_gbuffer.cpp
// checks.
//
//   FULL     normalRoughness R32G32_UINT   x: [23..0] octahedral u, [31..24] roughness low byte
//                                          y: [23..0] octahedral v, [31..24] roughness high byte
//            albedo          RGBA16F       rgb: diffuse albedo
//            specular        RGBA16F       rgb: F0, a: specular weight (Schlick F90)
//   COMPACT  normalRoughness R32_UINT      [11..0] octahedral u, [23..12] v, [31..24] roughness
//            albedo          RGBA8_SRGB    rgb: base colour, a: metalness (linear)
//   Bytes per pixel: FULL 8 + 8 + 8, COMPACT 4 + 4; 4 more for depth. Radiance is not counted.
#ifndef CND_SHARED_GBUFFER_H
#define CND_SHARED_GBUFFER_H

#include "shared/prelude.h"

GPU_BEGIN

// CndGBufferLayout.
const uint GBUFFER_LAYOUT_FULL = 0u;
const uint GBUFFER_LAYOUT_COMPACT = 1u;
const uint GBUFFER_LAYOUT_HOST = 2u;
const uint GBUFFER_LAYOUT_CUSTOM = 3u;

// Octahedral coordinates are signed: k / (2^(bits-1) - 1). The most negative code is not a
// direction.
const uint NORMAL_BITS_FULL = 24u;
const uint NORMAL_BITS_COMPACT = 12u;

// Largest angle in radians between a unit normal and what unpacking returns. At the middle of a
// face of the octahedron half a step in both coordinates turns the normal by sqrt(18) half steps;
// the bound of FULL adds the rounding of floats.
const float NORMAL_ERROR_FULL = 6e-7f;       // sqrt(18) / 2 / (2^23 - 1) = 2.53e-7
const float NORMAL_ERROR_COMPACT = 1.04e-3f; // sqrt(18) / 2 / (2^11 - 1) = 1.036e-3
// Largest error of the perceptual roughness in [0, 1]: half a step of the unorm.
const float ROUGHNESS_ERROR_FULL = 7.7e-6f;
const float ROUGHNESS_ERROR_COMPACT = 1.97e-3f;

// COMPACT marks pixels that lights must not light (visible emitters) by the octahedral u that is
// not a direction. FULL marks them by an albedo, F0 and specular weight of 0.
const uint NORMAL_ROUGHNESS_UNLIT_COMPACT = 0x800u;

// F0 of dielectrics in COMPACT (glTF 2.0, index of refraction 1.5).
const float DIELECTRIC_F0 = 0.04f;

GPU_END

#endif
