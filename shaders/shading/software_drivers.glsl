// SPDX-License-Identifier: Apache-2.0
// What shaders do for drivers that run them on a CPU, and why. Shaders are written for GPUs. A kernel
// whose lanes share work in another way on a CPU has a second form in kernels/cpu. The switches that
// several shaders use are here. What concerns one function is explained there.
//
// llvmpipe (Mesa 22.3), whose lanes are a vector of the CPU:
// - It reads texel buffers five times faster than storage buffers: READ.
// - Its variables are in the processor's cache anyway, and it does not wait for reads. So lanes keep
//   nothing in shared memory and read nothing ahead: forCpu.
// - It runs the body of a loop once even if no lane needs it. So loops test their condition at the end,
//   and a loop that is known not to be needed is left out: tileHeight. The same holds for the body of
//   an `if`. But it leaves a loop when no lane is left in it.
// - If a loop whose count differs between lanes is within another, it runs a lane that is done once
//   more. This turn must add nothing: IF_ANY_LEFT. Elsewhere it is harmless, because the lane then has
//   an empty block of lights, or writes to a place that nothing reads.
// - It reads a uniform again in each turn of a loop, so the parameters of the frame are copied first.
//
// SwiftShader: while some lanes of a subgroup are in a loop, it also runs the loop's body for those
// that have left it, with reads of storage buffers and shared memory that give 0. What they compute
// replaces the value with which they left, unless it is assigned under a condition that is false in
// them (tools/bench/RESULTS.md, decision 42). So such a loop asks for its condition in its body too, if
// lanes may leave it one by one: IF_COUNTS_DIFFER.
#ifndef CND_SHADING_SOFTWARE_DRIVERS
#define CND_SHADING_SOFTWARE_DRIVERS

#extension GL_EXT_samplerless_texture_functions : require
#include "shared/lighting_data.h"

// forCpu tells whether the kernel runs on llvmpipe and texel buffers are large enough for all lights
// (engine/lights/light_limits.h). tileHeight is the height of the tiles that it
// shades (shared/lighting_data.h), which is ANY_HEIGHT on GPUs. Shaders of hosts have no such
// constants.
#ifdef LIGHT_FAMILY_ALL
const bool forCpu = false;
const uint tileHeight = ANY_HEIGHT;
#else
layout(constant_id = SPEC_FOR_CPU) const bool forCpu = false;
layout(constant_id = SPEC_TILE_HEIGHT) const uint tileHeight = ANY_HEIGHT;
#endif

// Reads an element of an array that is bound as a storage buffer, and also as a texel buffer.
#define READ(buffer, texels, at) (forCpu ? texelFetch(texels, int(at)) : buffer[at])
#define READ_UINT(buffer, texels, at) (forCpu ? texelFetch(texels, int(at)).x : buffer[at])

// The includer defines COUNTS_DIFFER as true if blocks of one subgroup may be of different sizes and
// its function lightAt or lightCentre reads a storage buffer or shared memory.
#ifndef COUNTS_DIFFER
#define COUNTS_DIFFER false
#endif
#define IF_COUNTS_DIFFER(condition) if (!COUNTS_DIFFER || (condition))

// Outlines have loops whose count differs between lanes. A shadow term reads the light's id from a
// storage buffer.
#define IF_ANY_LEFT(left) if (!(HAS_OUTLINES || HAS_SHADOW_TERM) || !none(left))

#endif
