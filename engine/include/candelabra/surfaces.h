// SPDX-License-Identifier: Apache-2.0
// The view whose surfaces the lighting and environment modules shade: camera, G-buffer, lobes.
#ifndef CANDELABRA_SURFACES_H
#define CANDELABRA_SURFACES_H

#include "candelabra/core.h"

#ifdef __cplusplus
extern "C" {
#endif

// A camera. The view transform is double; the projection is float.
typedef struct CndCamera {
    double viewFromWorld[16]; // rigid: rotation and translation only
    float clipFromView[16];   // perspective (finite or infinite, reversed or not) or orthographic
} CndCamera;

// G-buffer layouts the modules can read. See shaders/lib/gbuffer.glsl for packing functions of the
// first two and their declared error bounds.
typedef enum CndGBufferLayout {
    // normalRoughness R32G32_UINT: view-space octahedral normal 24+24 bits, perceptual roughness
    // unorm 16 (below 0.0447, that is alpha below 0.002, specular is evaluated at alpha 0.002);
    // albedo R16G16B16A16_SFLOAT: diffuse albedo (already scaled by 1 - metalness), a unused;
    // specular R16G16B16A16_SFLOAT: F0, a = Schlick F90 (with F0 = 0 as well: no specular lobe).
    CND_GBUFFER_FULL = 0,
    // normalRoughness R32_UINT: octahedral normal 12+12 bits, perceptual roughness unorm 8;
    // albedo R8G8B8A8_SRGB: base colour, a = metalness; F0 = mix(0.04, base colour, metalness).
    CND_GBUFFER_COMPACT = 1,
    // The host's own, as CndGBufferDesc says.
    CND_GBUFFER_HOST = 2,
    // Whatever a function of the host's reads (candelabra/compiler.h: CND_HOST_READ_SURFACE_BIT).
    // Of a frame's images depth alone is used, the others may be null.
    CND_GBUFFER_CUSTOM = 3,
    CND_GBUFFER_LAYOUT_MAX_ENUM = 0x7FFFFFFF
} CndGBufferLayout;

// How normalRoughness holds the normal. What is read is normalised; a normal that is zero, NaN or
// infinite counts as (0, 0, 1) of view space.
typedef enum CndNormalEncoding {
    CND_NORMAL_UNORM = 0,            // rgb: 0.5 + 0.5 * normal
    CND_NORMAL_SNORM = 1,            // rgb: the normal; signed formats (SNORM, SFLOAT)
    CND_NORMAL_OCTAHEDRAL_UNORM = 2, // rg: 0.5 + 0.5 * p, p of encodeOctahedral() in gbuffer.glsl
    CND_NORMAL_OCTAHEDRAL_SNORM = 3, // rg: p; signed formats
    CND_NORMAL_ENCODING_MAX_ENUM = 0x7FFFFFFF
} CndNormalEncoding;

// The space of the normals; those of the world are rotated by CndCamera::viewFromWorld.
typedef enum CndNormalSpace {
    CND_NORMALS_VIEW = 0,
    CND_NORMALS_WORLD = 1,
    CND_NORMAL_SPACE_MAX_ENUM = 0x7FFFFFFF
} CndNormalSpace;

// A channel of one of a frame's images: normalRoughness, albedo or specular.
typedef enum CndGBufferChannel {
    CND_CHANNEL_NONE = 0,
    CND_CHANNEL_NORMAL_R = 1,
    CND_CHANNEL_NORMAL_G = 2,
    CND_CHANNEL_NORMAL_B = 3,
    CND_CHANNEL_NORMAL_A = 4,
    CND_CHANNEL_ALBEDO_R = 5,
    CND_CHANNEL_ALBEDO_G = 6,
    CND_CHANNEL_ALBEDO_B = 7,
    CND_CHANNEL_ALBEDO_A = 8,
    CND_CHANNEL_SPECULAR_R = 9,
    CND_CHANNEL_SPECULAR_G = 10,
    CND_CHANNEL_SPECULAR_B = 11,
    CND_CHANNEL_SPECULAR_A = 12,
    CND_CHANNEL_MAX_ENUM = 0x7FFFFFFF
} CndGBufferChannel;

// What the roughness channel holds, 0..1 (what lies beyond counts as the nearer end).
typedef enum CndRoughnessKind {
    CND_ROUGHNESS_PERCEPTUAL = 0, // alpha is its square (glTF, most renderers)
    CND_ROUGHNESS_ALPHA = 1,      // the GGX width itself
    CND_ROUGHNESS_SMOOTHNESS = 2, // 1 - perceptual roughness, also called glossiness
    CND_ROUGHNESS_KIND_MAX_ENUM = 0x7FFFFFFF
} CndRoughnessKind;

typedef enum CndReflectance {
    // albedo.rgb: base colour. Diffuse albedo is base colour * (1 - metalness), F0 is
    // mix(dielectricF0, base colour, metalness), F90 is 1.
    CND_REFLECTANCE_METALNESS = 0,
    // albedo.rgb: diffuse albedo; specular.rgb: F0.
    CND_REFLECTANCE_SPECULAR = 1,
    CND_REFLECTANCE_MAX_ENUM = 0x7FFFFFFF
} CndReflectance;

// The host's own G-buffer, for CND_GBUFFER_HOST: what the channels of the frame's images hold.
// Shaders read all of them as floats: no UINT or SINT views. Colours are linear when read (give a
// _SRGB view of what is stored encoded). Everything is checked at creation, against formats too
// where they are told.
typedef struct CndGBufferDesc {
    CndNormalEncoding normalEncoding;
    CndNormalSpace normalSpace;
    CndGBufferChannel roughness; // not NONE
    CndRoughnessKind roughnessKind;
    CndReflectance reflectance;
    CndGBufferChannel metalness; // CND_REFLECTANCE_METALNESS, 0..1; NONE: nothing is a metal
    float dielectricF0;          // CND_REFLECTANCE_METALNESS, 0..1; 0: 0.04
    CndGBufferChannel f90;       // CND_REFLECTANCE_SPECULAR: Schlick's F90, 0..1; NONE: 1
    // Of the views, as far as the host wants them checked, else VK_FORMAT_UNDEFINED. Depth: D16,
    // D24 or D32, with stencil or without, or R32_SFLOAT as a colour.
    VkFormat normalRoughnessFormat, albedoFormat, specularFormat, depthFormat;
} CndGBufferDesc;

// A kernel that has functions of the host's in it, as SPIR-V. Made by cndCompileKernels
// (candelabra/compiler.h) of the same version, at run time or long before.
typedef struct CndKernelCode {
    const char* name; // of the kernel it replaces, "shade_tiles:CONIC" for instance
    const uint32_t* words;
    uint32_t wordCount;
} CndKernelCode;

// Kernels in place of the module's own. Each must have the bindings and parameters of the one it
// replaces, which is checked; what else it does is the host's matter. Those of another module are
// left alone.
typedef struct CndHostKernels {
    uint32_t count;               // 0: none
    const CndKernelCode* kernels; // read before the call returns
    // Of descriptor set 1 in them, with the compute stage; must outlive the module. VK_NULL_HANDLE:
    // they have no bindings of their own.
    VkDescriptorSetLayout setLayout;
} CndHostKernels;

// How the diffuse and the specular lobe of a surface share the light.
typedef enum CndLobeJoining {
    // The diffuse lobe gets what the specular one leaves of a white surrounding, by the specular
    // lobe's directional albedo: the two together never reflect more than there is. Default.
    CND_LOBES_CONSERVING = 0,
    // The lobes are added, nothing is taken from the diffuse one: up to twice what there is at
    // grazing angles. What the scene description (.json) and path tracers of two-lobe materials do.
    CND_LOBES_SUM = 1,
    CND_LOBES_MAX_ENUM = 0x7FFFFFFF
} CndLobeJoining;

#ifdef __cplusplus
}
#endif
#endif
