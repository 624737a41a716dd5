// SPDX-License-Identifier: Apache-2.0
// G-buffer packing: field widths and the declared error bounds that tests/gpu/test_gbuffer.cpp
// checks.
//
//   FULL     normalRoughness R32G32_UINT   x: [22..0] octahedral u, [31..23] roughness, low 9 bits
//                                          y: [22..0] octahedral v, [31..23] roughness, high 9 bits
//            albedo          R32G32_UINT   diffuse albedo
//                                          x: [20..0] red, [31..21] blue, low 11 bits
//                                          y: [20..0] green, [30..21] blue, high 10 bits, [31] 0
//            specular        R32G32_UINT   F0 and specular weight (Schlick's F90). If F90 is 1:
//                                          F0 like the albedo, y [31] 1; otherwise:
//                                          x: [15..0] red, [31..16] green of F0
//                                          y: [15..0] blue of F0, [30..16] F90 as unorm, [31] 0
//   COMPACT  normalRoughness R32_UINT      [11..0] octahedral u, [23..12] v, [31..24] roughness
//            albedo          RGBA8_SRGB    rgb: base colour, a: metalness (linear)
//   Bytes per pixel: FULL 8 + 8 + 8, COMPACT 4 + 4; 4 more for depth. Radiance is not counted.
//
// Roughness, albedo and F0 of FULL are unit floats: numbers from 0 to 1 in 3 + m bits. The code c
// stands for 0 if it is 0. Otherwise c + 1 has an exponent e in its upper bits and a mantissa f in
// its lower m bits, and stands for 2^(e-8) (1 + f / 2^m), or, where e is 0, for 2^-7 f / 2^m. So 1
// has the largest code, 2^(m+3) - 1, and the smallest step 2^-(m+7) is the only multiple of it that
// is left out. Shaders make the codes from the bits of floats, so that they are the same on every
// device.
#ifndef CND_SHARED_GBUFFER_DATA_H
#define CND_SHARED_GBUFFER_DATA_H

#include "shared/prelude.h"

GPU_BEGIN

// CndGBufferLayout.
const uint GBUFFER_LAYOUT_FULL = 0u;
const uint GBUFFER_LAYOUT_COMPACT = 1u;
const uint GBUFFER_LAYOUT_HOST = 2u;
const uint GBUFFER_LAYOUT_CUSTOM = 3u;

// Octahedral coordinates are signed: k / (2^(bits-1) - 1). The most negative code is not a
// direction.
const uint NORMAL_BITS_FULL = 23u;
const uint NORMAL_BITS_COMPACT = 12u;

// Largest angle in radians between a unit normal and what unpacking returns. At the middle of a
// face of the octahedron half a step in both coordinates turns the normal by sqrt(18) half steps;
// the bound of FULL adds the rounding of floats.
const float NORMAL_ERROR_FULL = 9e-7f;       // sqrt(18) / 2 / (2^22 - 1) = 5.06e-7
const float NORMAL_ERROR_COMPACT = 1.04e-3f; // sqrt(18) / 2 / (2^11 - 1) = 1.036e-3

// Bits of the mantissa of unit floats.
const uint COLOUR_MANTISSA = 18u;       // albedo, and F0 where F90 is 1
const uint COLOUR_MANTISSA_SHORT = 13u; // F0 where F90 is below 1
const uint ROUGHNESS_MANTISSA = 15u;
const uint F90_BITS = 15u;
// Largest relative errors of unit floats from UNIT_FLOAT_NORMAL on: 2^-(m+1). Below that the error
// is at most three halves of the smallest step, which is UNIT_FLOAT_NORMAL / 2^m.
const float UNIT_FLOAT_NORMAL = 0.0078125f;     // 2^-7
const float COLOUR_ERROR_FULL = 1.91e-6f;       // 2^-19
const float COLOUR_ERROR_FULL_SHORT = 6.11e-5f; // 2^-14
const float ROUGHNESS_ERROR_FULL = 1.53e-5f;    // 2^-16
// Largest errors of F90 in FULL and of perceptual roughness in COMPACT: half a step of the unorm,
// and the rounding of the division that unpacks it, which Vulkan allows to be wrong by 2.5 ULP.
const float F90_ERROR_FULL = 1.55e-5f;
const float ROUGHNESS_ERROR_COMPACT = 1.97e-3f;

// COMPACT marks pixels that lights must not light (visible emitters) by the octahedral u that is
// not a direction. FULL marks them by an albedo, F0 and specular weight of 0: all bits of both
// images are 0.
const uint NORMAL_ROUGHNESS_UNLIT_COMPACT = 0x800u;

// F0 of dielectrics in COMPACT (glTF 2.0, index of refraction 1.5).
const float DIELECTRIC_F0 = 0.04f;

GPU_END

#endif
