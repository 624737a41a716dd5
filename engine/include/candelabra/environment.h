// SPDX-License-Identifier: Apache-2.0
// The environment module: lights a scene by an image of its far surroundings.
#ifndef CANDELABRA_ENVIRONMENT_H
#define CANDELABRA_ENVIRONMENT_H

#include "candelabra/core.h"
#include "candelabra/surfaces.h"

#ifdef __cplusplus
extern "C" {
#endif

// An environment image, prepared for shading. One object can light any number of views.
typedef struct CndEnvironment_T* CndEnvironment;

typedef struct CndEnvironmentDesc {
    uint32_t structSize;
    uint32_t framesInFlight; // 1..8: frames recorded and not yet waited for, all views together
    CndGBufferLayout gbufferLayout;
    // Side of a cube face in texels, a power of two in 64..2048; 0: default, 256. It limits the
    // sharpness of the background and of mirror reflections. Diffuse light does not depend on it.
    // The module takes 256 * cubeSize^2 bytes for it, and 1 MB more (18 MB in all for 256).
    uint32_t cubeSize;
    VkBool32 timestamps; // VK_TRUE: measure the GPU time of every kernel
    CndGBufferDesc gbuffer;
    VkFormat radianceFormat;    // as CndLightingDesc::radianceFormat
    CndHostKernels hostKernels; // kernels with functions of the host; only shade_environment is
                                // used
} CndEnvironmentDesc;

// The largest luminance of an environment image, cd/m^2: 1000 times that of the Sun's disc.
#define CND_ENVIRONMENT_MAX_LUMINANCE 2e12f

// An equirectangular (latitude-longitude) image: up (+y) is the top row, -z is the middle, +x is to
// the right of the middle. It holds luminance in cd/m^2 per Rec.709 channel. NaN and negative
// values are read as 0, and values above CND_ENVIRONMENT_MAX_LUMINANCE as that limit. On entry the
// image has a float format, is in VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL and is visible to
// COMPUTE_SHADER / SHADER_SAMPLED_READ. Each texel lights surfaces from its own direction, with its
// luminance times its exact solid angle. The image is no longer needed once the GPU has finished
// the recording.
typedef struct CndEnvironmentMap {
    uint32_t structSize;
    uint32_t width, height; // texels, 1..16384
    VkImageView equirectangular;
} CndEnvironmentMap;

// One frame of one view. The G-buffer, and the states of images on entry and on exit, are as for
// CndLightingFrame. It may be recorded before or after the CndLightingFrame of the same view. If it
// comes second, the host records a memory barrier between the two. If it comes first, the barrier
// at the start of cndRecordLighting is enough.
typedef struct CndEnvironmentFrame {
    uint32_t structSize;
    uint32_t frameSlot; // 0..framesInFlight-1; the GPU must have finished the slot's previous frame
    uint32_t x, y;      // as CndLightingFrame::x and y
    uint32_t width, height; // pixels, 1..16384
    CndCamera camera;
    // The value of pixels without a surface. With CND_DEPTH_PROJECTED it is 0 with reversed depth,
    // else 1; the depth of the near end of a perspective camera is refused. Otherwise it is any
    // finite number, to which red (CND_DEPTH_LINEAR) or alpha (positions) is cleared.
    float clearDepth;
    VkImageView normalRoughness;
    VkImageView albedo;
    VkImageView specular; // may be VK_NULL_HANDLE if the layout does not read it
                          // (CND_GBUFFER_COMPACT)
    VkImageView depth;    // of a depth format a view of the depth aspect; CndGBufferDesc::depthKind
    // The layouts of the images on entry and on exit: one for normalRoughness, albedo and specular,
    // and one for depth. VK_IMAGE_LAYOUT_UNDEFINED (0) means SHADER_READ_ONLY_OPTIMAL; also allowed
    // are READ_ONLY_OPTIMAL and GENERAL, and for depth DEPTH_STENCIL_READ_ONLY_OPTIMAL,
    // DEPTH_READ_ONLY_STENCIL_ATTACHMENT_OPTIMAL and DEPTH_READ_ONLY_OPTIMAL.
    VkImageLayout gbufferImageLayout, depthImageLayout;
    // Storage image of radianceFormat; outgoing luminance (cd/m^2) is ADDED to it.
    VkImageView radiance;
    float worldFromEnvironment[9]; // rotation matrix (3 columns) from the space of the image to the
                                   // world
    float scale;                   // >= 0 and finite, factor on the luminance of the image
    // VK_TRUE: also show the environment in pixels without a surface. Its luminance is ADDED there
    // too. So clear these pixels to 0, or to the distant lights that are visible in them.
    VkBool32 background;
    CndLobeJoining lobes;
    // VK_TRUE: compensate the energy that single-scattering microfacet models lose to multiple
    // bounces (Turquin 2019). Without it a white metal of roughness 1 loses up to 69% of the light.
    VkBool32 energyCompensation;
    VkDescriptorSet hostSet; // as CndLightingFrame::hostSet
} CndEnvironmentFrame;

// Kernel times in milliseconds. The host sets structSize before the call.
typedef struct CndEnvironmentStats {
    uint32_t structSize;
    uint32_t kernelTimeCount; // number of elements in kernelTimes; 0 without timestamps
    CndKernelTime kernelTimes[CND_MAX_KERNEL_TIMES];
    uint32_t mapKernelTimeCount; // likewise in mapKernelTimes, of the last cndRecordEnvironmentMap
    CndKernelTime mapKernelTimes[CND_MAX_KERNEL_TIMES];
} CndEnvironmentStats;

// Writes exactly how much memory cndCreateEnvironment will take, without allocating any. Fails with
// the same errors as creation would.
CND_API CndResult cndPlanEnvironment(const CndDeviceDesc* device, const CndEnvironmentDesc* desc,
                                     CndMemoryUsage* usage, CndError* error);
// Creates the module.
CND_API CndResult cndCreateEnvironment(const CndDeviceDesc* device, const CndEnvironmentDesc* desc,
                                       CndEnvironment* environment, CndError* error);
// The GPU must have finished all work recorded with the object. NULL is ignored.
CND_API void cndDestroyEnvironment(CndEnvironment environment);
// Writes how much memory the object holds. It stays the same from creation on.
CND_API CndResult cndGetEnvironmentMemory(CndEnvironment environment, CndMemoryUsage* usage,
                                          CndError* error);
// Records the preparation of an environment image: a cube map, a prefiltered cube map and
// irradiance. The first recording also fills the table of the specular lobe's directional albedo.
// The GPU must have finished everything that was recorded with the object before. Submit the
// recording before the frames that use it, to the same queue. Changes the compute pipeline, compute
// descriptor set 0 and the push constants; must be recorded outside a render pass.
CND_API CndResult cndRecordEnvironmentMap(CndEnvironment environment, VkCommandBuffer cmd,
                                          const CndEnvironmentMap* map, CndError* error);
// Records the shading of one frame, which is one kernel. cndRecordEnvironmentMap must have been
// recorded before. The specular term is a split-sum approximation. It is exact in surroundings of
// constant luminance. Otherwise the lobe has the shape that it has when viewed along the normal.
// There are no shadows. Changes the same state as cndRecordEnvironmentMap (and compute descriptor
// set 1 with host kernels); must be recorded outside a render pass.
CND_API CndResult cndRecordEnvironment(CndEnvironment environment, VkCommandBuffer cmd,
                                       const CndEnvironmentFrame* frame, CndError* error);
// Writes kernel times of the last frame recorded in frameSlot, and of the last map. With
// CndEnvironmentDesc::timestamps, returns CND_NOT_READY until the GPU has finished both. Without
// timestamps it returns CND_SUCCESS at once, with no kernel times. Returns
// CND_ERROR_INVALID_ARGUMENT before the first frame of the slot.
CND_API CndResult cndGetEnvironmentStats(CndEnvironment environment, uint32_t frameSlot,
                                         CndEnvironmentStats* stats);

#ifdef __cplusplus
}
#endif
#endif
