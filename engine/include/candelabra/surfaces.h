// SPDX-License-Identifier: Apache-2.0
// The surfaces that the lighting and environment modules shade: camera, G-buffer, lobes.
#ifndef CANDELABRA_SURFACES_H
#define CANDELABRA_SURFACES_H

#include "candelabra/core.h"

#ifdef __cplusplus
extern "C" {
#endif

// A camera. The view transform is double; the projection is float. Matrices are column-major.
typedef struct CndCamera {
    // A rotation and a translation, without scale or reflection. The last row is 0, 0, 0, 1. A
    // transposed matrix is refused if it has a translation.
    double viewFromWorld[16];
    // Perspective (finite or infinite, depth reversed or not) or orthographic. Off-centre
    // projections are allowed; shear is not. A perspective projection that is transposed, or that
    // gives nothing in front of the eye a depth of 0..1, is refused. Precision: with reversed depth
    // in D32_SFLOAT, perspective positions are exact to 6e-8 of their distance from the eye,
    // whatever the far plane. Orthographic depth is linear, and positions are exact to 6e-8 (far -
    // near). For a range of 1e6 m that is 6 cm, with which a point light at 1 m is wrong by up to
    // 12%. So put both planes near the scene. With a range of 1e4 times the distance from surfaces
    // to lights, the error is 0.1%.
    float clipFromView[16];
} CndCamera;

// The smallest alpha, the square of perceptual roughness, with which the specular lobe is
// evaluated.
#define CND_MIN_ALPHA 0.002f

// The G-buffer layouts that the modules can read. shaders/lib/gbuffer.glsl has packing functions
// for the first two layouts and states their error bounds.
typedef enum CndGBufferLayout {
    // All three images are R32G32_UINT, with bits that are the same on every device.
    // normalRoughness: view-space octahedral normal in 23+23 bits, perceptual roughness in 18 bits
    // (below 0.0447, alpha is below CND_MIN_ALPHA).
    // albedo: diffuse albedo (already multiplied by 1 - metalness), 21 bits a channel. specular:
    // F0 and Schlick's F90, 21 bits a channel if F90 is 1, otherwise 16 bits a channel and 15 bits
    // of F90 (F90 = 0 with F0 = 0: no specular lobe). Zeros in albedo and specular reflect nothing.
    CND_GBUFFER_FULL = 0,
    // normalRoughness R32_UINT: octahedral normal in 12+12 bits, perceptual roughness in 8 bits
    // unorm. albedo R8G8B8A8_SRGB: base colour, and metalness in alpha; F0 = mix(0.04, base colour,
    // metalness).
    CND_GBUFFER_COMPACT = 1,
    // The host's own layout, described by CndGBufferDesc.
    CND_GBUFFER_HOST = 2,
    // Surfaces are read by a GLSL function of the host (candelabra/compiler.h,
    // CND_HOST_READ_SURFACE_BIT). The module itself reads only the depth image of a frame, as
    // CndGBufferDesc::depthKind describes it; its other images may be null.
    CND_GBUFFER_CUSTOM = 3,
    CND_GBUFFER_LAYOUT_MAX_ENUM = 0x7FFFFFFF
} CndGBufferLayout;

// How normalRoughness encodes the normal. The decoded normal is normalised. A normal that is NaN,
// or whose length is not between 1e-6 and 1e6, is replaced by (0, 0, 1) in view space.
typedef enum CndNormalEncoding {
    CND_NORMAL_UNORM = 0,            // rgb holds 0.5 + 0.5 * normal
    CND_NORMAL_SNORM = 1,            // rgb holds the normal; needs a signed format (SNORM, SFLOAT)
    CND_NORMAL_OCTAHEDRAL_UNORM = 2, // rg holds 0.5 + 0.5 * p, p = encodeOctahedral() of
                                     // gbuffer.glsl
    CND_NORMAL_OCTAHEDRAL_SNORM = 3, // rg holds p; needs a signed format
    CND_NORMAL_ENCODING_MAX_ENUM = 0x7FFFFFFF
} CndNormalEncoding;

// The space of the normals. World-space normals are rotated by CndCamera::viewFromWorld.
typedef enum CndNormalSpace {
    CND_NORMALS_VIEW = 0,
    CND_NORMALS_WORLD = 1,
    CND_NORMAL_SPACE_MAX_ENUM = 0x7FFFFFFF
} CndNormalSpace;

// What the image `depth` of a frame holds. Kinds other than CND_DEPTH_PROJECTED need no depth
// range: only the x, y and w that clipFromView computes then matter. A kernel computes depth from
// these kinds, once per frame.
typedef enum CndDepthKind {
    // The depth of clipFromView, as the raster pass writes it: clip z / clip w, 0..1. One end of
    // this range is clearDepth.
    CND_DEPTH_PROJECTED = 0,
    // Red holds the distance from the eye along the z axis of view space, |z|, in units of
    // depthUnit. Its sign does not matter. Do not store the distance from the eye to the position
    // along the ray, which is a different number.
    CND_DEPTH_LINEAR = 1,
    // rgb holds the position in view space, in metres; alpha differs from clearDepth.
    CND_DEPTH_POSITION_VIEW = 2,
    // rgb holds the position in world space, in metres; alpha differs from clearDepth.
    CND_DEPTH_POSITION_WORLD = 3,
    CND_DEPTH_KIND_MAX_ENUM = 0x7FFFFFFF
} CndDepthKind;

// One channel of one image of a frame: normalRoughness, albedo or specular.
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

// What the roughness channel holds. Values outside 0..1 are clamped after conversion to perceptual
// roughness.
typedef enum CndRoughnessKind {
    CND_ROUGHNESS_PERCEPTUAL = 0, // perceptual roughness, whose square is alpha (glTF, most
                                  // renderers)
    CND_ROUGHNESS_ALPHA = 1,      // alpha, the width of the GGX distribution
    CND_ROUGHNESS_SMOOTHNESS = 2, // 1 - perceptual roughness, also called glossiness
    CND_ROUGHNESS_KIND_MAX_ENUM = 0x7FFFFFFF
} CndRoughnessKind;

// How albedo and specular images define diffuse albedo and specular reflectance.
typedef enum CndReflectance {
    // Metalness workflow: albedo.rgb holds the base colour. Diffuse albedo is base colour * (1 -
    // metalness), F0 is mix(dielectricF0, base colour, metalness), F90 is 1.
    CND_REFLECTANCE_METALNESS = 0,
    // Specular workflow: albedo.rgb holds the diffuse albedo, specular.rgb holds F0.
    CND_REFLECTANCE_SPECULAR = 1,
    CND_REFLECTANCE_MAX_ENUM = 0x7FFFFFFF
} CndReflectance;

// The host's own G-buffer: what each channel of the frame's images holds. The members about depth
// are read with every layout, the others with CND_GBUFFER_HOST only. All images have one sample per
// pixel (INTEGRATION.md says what to do with multisampled ones). Shaders read all channels as
// floats, so views must not be UINT or SINT. Colours must be linear when read. If an image stores
// encoded colours, pass an _SRGB view of it. The description is checked when the module is created.
// If formats are given, it is checked against them too.
typedef struct CndGBufferDesc {
    CndNormalEncoding normalEncoding;
    CndNormalSpace normalSpace;
    CndGBufferChannel roughness; // CND_CHANNEL_NONE: constantRoughness everywhere
    float constantRoughness;     // without a channel: perceptual roughness, above 0 and at most 1;
                                 // otherwise 0
    CndRoughnessKind roughnessKind; // of the channel
    CndReflectance reflectance;
    CndGBufferChannel metalness; // with CND_REFLECTANCE_METALNESS, 0..1; CND_CHANNEL_NONE:
                                 // constantMetalness everywhere
    float constantMetalness;     // 0..1; with a channel, or with CND_REFLECTANCE_SPECULAR: 0
    float dielectricF0;    // with CND_REFLECTANCE_METALNESS, 0..1: F0 of what is no metal; 0 means
                           // 0.04
    CndGBufferChannel f90; // with CND_REFLECTANCE_SPECULAR: Schlick's F90, 0..1; CND_CHANNEL_NONE:
                           // F90 is 1
    // Formats of the image views, for the checks; VK_FORMAT_UNDEFINED skips the check of that
    // image. Projected depth may be D16, D24 or D32, with or without stencil, or R32_SFLOAT as a
    // colour format; linear depth any format of floats; positions four channels with both signs.
    VkFormat normalRoughnessFormat, albedoFormat, specularFormat, depthFormat;
    CndDepthKind depthKind;
    float depthUnit; // with CND_DEPTH_LINEAR: metres per unit of what is stored, above 0, for
                     // example the far plane where |z| / far is stored; 0 means 1
} CndGBufferDesc;

// SPIR-V of one kernel that contains functions of the host. cndCompileKernels
// (candelabra/compiler.h) of the same version of Candelabra must have made it, at run time or
// earlier.
typedef struct CndKernelCode {
    const char* name; // name of the kernel that it replaces, for example "shade_tiles:CONIC"
    const uint32_t* words;
    uint32_t wordCount; // length of `words`, in 32-bit words
} CndKernelCode;

// Kernels that replace the module's own. Each must have the bindings and parameters of the kernel
// that it replaces, which is checked. The host is responsible for everything else that it does.
// Kernels that only another module uses are ignored.
typedef struct CndHostKernels {
    uint32_t count;               // 0: no kernel is replaced
    const CndKernelCode* kernels; // read before the call returns
    // Layout of descriptor set 1 in these kernels; its bindings need the compute stage. It must
    // outlive the module. VK_NULL_HANDLE: the kernels have no bindings in set 1.
    VkDescriptorSetLayout setLayout;
} CndHostKernels;

// How the diffuse and the specular lobe of a surface share the incoming light.
typedef enum CndLobeJoining {
    // Energy-conserving, the default. The diffuse lobe is scaled by 1 - the specular lobe's
    // directional albedo, so both together never reflect more light than arrives.
    CND_LOBES_CONSERVING = 0,
    // The lobes are simply added. At grazing angles this can reflect up to twice the incoming
    // light. Scene descriptions (.json) and path tracers with two-lobe materials do this.
    CND_LOBES_SUM = 1,
    CND_LOBES_MAX_ENUM = 0x7FFFFFFF
} CndLobeJoining;

#ifdef __cplusplus
}
#endif
#endif
