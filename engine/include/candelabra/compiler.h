// SPDX-License-Identifier: Apache-2.0
// Compiles GLSL functions written by the host into the kernels that shade. It is a separate
// library, candelabra::compiler (libcandelabra_compiler), so hosts that do not need it link no
// compiler. It needs no device and reads no file. Its output is SPIR-V for CndHostKernels, which
// the host may store and reuse until the version of Candelabra changes.
#ifndef CANDELABRA_COMPILER_H
#define CANDELABRA_COMPILER_H

#include "candelabra/core.h"
#include "candelabra/lighting.h"
#include "candelabra/surfaces.h"

#ifdef __cplusplus
extern "C" {
#endif

// The functions that CndCompileDesc::source defines. Kernels call them, so their signatures must be
// exactly these.
typedef enum CndHostFunctionBits {
    // `float candelabraVisibility(CndShadowQuery query)`: a finite shadow term, from 0 (in shadow)
    // to 1 (fully lit). It multiplies every light where the light is evaluated. Members of the
    // query are in view space, in metres:
    // - `light` is the low half of the light's CndLightId. It is unique within the set and smaller
    //   than the largest number of lights that the set has ever had, so it can index an array. For
    //   CndDeviceLights it is CND_LIGHT_OF_DEVICE plus the light's index.
    // - `type` is CND_LIGHT_SPHERE, CND_LIGHT_POINT ...
    // - `position` and `normal` (unit) are the surface's.
    // - `toLight` points from the surface to the light's centre. For distant lights it is the unit
    //   vector towards the light.
    CND_HOST_VISIBILITY_BIT = 1,
    // `CndSurface candelabraReadSurface(ivec2 texel)`: the surface of a pixel, for
    // CND_GBUFFER_CUSTOM. `texel` counts from the corner of the images, and `texel -
    // ivec2(cndGbufferView.firstTexel)` from the corner of the frame (CndLightingFrame::x and y).
    // The function is called only for pixels whose depth holds a surface. It must fill in `normal`,
    // `albedo`, `F0`, `specularWeight` (Schlick's F90) and `perceptualRoughness`. `normal` is in
    // view space and has any length between 1e-6 and 1e6: the kernel normalises it. Compute it with
    // `precise` variables, so that every kernel gets the same bits. The camera's rotation is
    // available as cndGbufferView.viewFromWorld.
    CND_HOST_READ_SURFACE_BIT = 2,
    // `uvec2 candelabraVisiblePoints(CndVisibilityQuery query)`: which points of a light a surface
    // sees, found with rays of the host. The module's kernels then ignore occluders:
    // every light but those with CndLight::unshadowed asks the function, in every frame without
    // CndLightingFrame::shadowsOff. It needs `shadows`. Everything is in view space, in metres:
    // - `light`, `type`, `position` and `normal` are as above.
    // - `points` are asked for: bit i of x, and bit i - 32 of y for the points from 32 on. The
    //   result has the bits of those that are seen. Other bits of it are ignored.
    // - `vec3 cndLightPoint(query, i)` is the way from `position` to point i of the light. It ends
    //   a little before the light's surface, so a ray tests all of it. For distant lights it is a
    //   direction of any length, and the ray has no end.
    // - `ownDistance`: a surface whose plane is at most so far from `position` hides nothing. It is
    //   the surface's own, as far as depth and rounding can tell.
    // - `unshadowedBy` is that of the light.
    CND_HOST_VISIBLE_POINTS_BIT = 4,
    CND_HOST_FUNCTION_MAX_ENUM = 0x7FFFFFFF
} CndHostFunctionBits;

typedef struct CndCompileDesc {
    uint32_t structSize;
    uint32_t functions; // mask of CndHostFunctionBits, not 0
    // GLSL 4.60 without its version directive, zero terminated: the functions, whatever they call,
    // and bindings in descriptor set 1 (`layout(set = 1, binding = 0) ...`). The source is appended
    // to each kernel. All names in a kernel begin with cnd, Cnd or CND_; your names may be any
    // others. It may include the installed shaders of "lib/" and "shared/".
    const char* source;
    const char* sourceName; // name of the source in error messages; NULL: "source"
    // The light types and specular methods that the lighting module will use. Fewer compile faster.
    // `lightTypes` is a mask of 1 << CndLightType, 0 for all types; `specularMethods` is a mask of
    // 1 << CndSpecularMethod, 0 for CND_SPECULAR_CONIC alone.
    uint32_t lightTypes, specularMethods;
    // VK_TRUE: the module will have shadows (CndLightingDesc::shadows), whose kernels differ from
    // those without. CND_HOST_VISIBLE_POINTS_BIT needs it.
    VkBool32 shadows;
    // The version of Vulkan that the code is for: VK_API_VERSION_1_1 (0 means this), 1_2 or 1_3.
    // They give SPIR-V 1.3, 1.5 and 1.6. The version may be lower than that of the device. It must
    // be higher than 1.1 only if the functions use something newer. Code for 1.3 needs the feature
    // maintenance4.
    uint32_t apiVersion;
} CndCompileDesc;

typedef struct CndCompiledKernels_T* CndCompiledKernels;

// Compiles every kernel that calls one of the functions. If the source has a mistake, the call
// fails with CND_ERROR_INVALID_ARGUMENT and one sentence: the name of the source, the line, and the
// compiler's message. May be called from several threads at once.
CND_API CndResult cndCompileKernels(const CndCompileDesc* desc, CndCompiledKernels* kernels,
                                    CndError* error);
// Returns the compiled kernels, for CndHostKernels, and writes their number to `count` (not NULL).
// The array is valid until cndDestroyCompiledKernels.
CND_API const CndKernelCode* cndGetKernelCode(CndCompiledKernels kernels, uint32_t* count);
CND_API void cndDestroyCompiledKernels(CndCompiledKernels kernels);

#ifdef __cplusplus
}
#endif
#endif
