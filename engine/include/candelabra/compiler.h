// SPDX-License-Identifier: Apache-2.0
// Functions of the host's in the kernels that shade, as GLSL source. A library of its own,
// candelabra::compiler (libcandelabra_compiler), so that nobody else links a compiler; it needs no
// device and reads no file. What it makes is SPIR-V for CndHostKernels, which may be kept for as
// long as the version of the library stays.
#ifndef CANDELABRA_COMPILER_H
#define CANDELABRA_COMPILER_H

#include "candelabra/core.h"
#include "candelabra/lighting.h"
#include "candelabra/surfaces.h"

#ifdef __cplusplus
extern "C" {
#endif

// The functions that CndCompileDesc::source defines.
typedef enum CndHostFunctionBits {
    // float candelabraVisibility(ShadowQuery query);
    // A shadow term, 0..1 and finite, that every light is multiplied by where it is evaluated. The
    // query has the light's id (`light`: the low half of its CndLightId, which no other light of
    // the set has and which is below the largest number of lights that the set has had;
    // LIGHT_OF_DEVICE plus its index for CndDeviceLights), its `type` (LIGHT_SPHERE, ...), the
    // surface's `position` and unit `normal`, and `toLight`, from there to the light's centre, of
    // distant lights the unit direction: view space, metres.
    CND_HOST_VISIBILITY_BIT = 1,
    // Surface candelabraReadSurface(ivec2 pixel);
    // The surface of a pixel for CND_GBUFFER_CUSTOM: `normal` of view space, any length (its
    // computation marked `precise`, so that every kernel gets the same bits), `albedo`, `F0`,
    // `specularWeight` (Schlick's F90), `perceptualRoughness`. gbufferView.viewFromWorld is the
    // camera's rotation. Is called where the frame's depth holds a surface.
    CND_HOST_READ_SURFACE_BIT = 2,
    CND_HOST_FUNCTION_MAX_ENUM = 0x7FFFFFFF
} CndHostFunctionBits;

typedef struct CndCompileDesc {
    uint32_t structSize;
    uint32_t functions; // mask of CndHostFunctionBits, not 0
    // GLSL 4.60 without its version directive, zero terminated: the functions, what they call, and
    // bindings of descriptor set 1 (`layout(set = 1, binding = 0) ...`). It stands behind each
    // kernel, whose names it sees; it may include what is installed of "lib/" and "shared/".
    const char* source;
    const char* sourceName; // in messages; NULL: "source"
    // What the lighting will be asked for: masks of 1 << CndLightType, 0: all types, and of
    // 1 << CndSpecularMethod, 0: CND_SPECULAR_CONIC. Fewer take less time.
    uint32_t lightTypes, specularMethods;
} CndCompileDesc;

typedef struct CndCompiledKernels_T* CndCompiledKernels;

// Compiles every kernel that the functions belong in. An error of the source is one sentence with
// its name, the line and what the compiler said. May be called from several threads.
CND_API CndResult cndCompileKernels(const CndCompileDesc* desc, CndCompiledKernels* kernels,
                                    CndError* error);
// For CndHostKernels; valid until cndDestroyCompiledKernels.
CND_API const CndKernelCode* cndGetKernelCode(CndCompiledKernels kernels, uint32_t* count);
CND_API void cndDestroyCompiledKernels(CndCompiledKernels kernels);

#ifdef __cplusplus
}
#endif
#endif
