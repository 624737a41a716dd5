// SPDX-License-Identifier: Apache-2.0
// The environment module: an image of the far surroundings as a light.
#ifndef CANDELABRA_ENVIRONMENT_H
#define CANDELABRA_ENVIRONMENT_H

#include "candelabra/core.h"
#include "candelabra/surfaces.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct CndEnvironment_T* CndEnvironment; // one image; any number of views

typedef struct CndEnvironmentDesc {
    uint32_t structSize;
    uint32_t framesInFlight; // 1..8, over all views together
    CndGBufferLayout gbufferLayout;
    // Texels of a cube face's side, a power of two 64..2048, 0 = default (256): what mirrors and
    // the background show. 256 * cubeSize^2 bytes (256: 17 MB).
    uint32_t cubeSize;
    VkBool32 timestamps;        // time every kernel
    CndGBufferDesc gbuffer;     // of CND_GBUFFER_HOST
    CndHostKernels hostKernels; // as of CndLightingDesc
} CndEnvironmentDesc;

// An equirectangular image: up (+y) at the top row, -z in the middle, +x to the right of it;
// luminance in cd/m^2 per Rec.709 channel. NaN and negative values count as 0, and nothing is
// brighter than 2e12.
// On entry: a float format in VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, visible to COMPUTE_SHADER /
// SHADER_SAMPLED_READ; not needed any more once the GPU has finished the recording.
typedef struct CndEnvironmentMap {
    uint32_t structSize;
    uint32_t width, height; // texels, 1..16384
    VkImageView equirectangular;
} CndEnvironmentMap;

// One frame of one view. Entry, exit and G-buffer as for CndLightingFrame; may stand before or
// after it (with a memory barrier between them, which cndRecordLighting begins with).
typedef struct CndEnvironmentFrame {
    uint32_t structSize;
    uint32_t frameSlot; // 0..framesInFlight-1; the GPU must have finished the slot's previous frame
    uint32_t width, height; // pixels, 1..16384
    CndCamera camera;
    float clearDepth; // depth of pixels without a surface: 0 with reversed depth, else 1
    VkImageView normalRoughness;
    VkImageView albedo;
    VkImageView specular; // may be VK_NULL_HANDLE where the layout reads none (COMPACT)
    VkImageView depth;    // depth aspect of a depth format, or R32_SFLOAT
    VkImageView radiance; // R32G32B32A32_SFLOAT, storage; outgoing luminance is ADDED (cd/m^2)
    float worldFromEnvironment[9]; // rotation of the image's space, columns
    float scale;                   // >= 0, factor on the image's luminance
    // The environment is seen, ADDED like all luminance, in pixels without a surface: clear those
    // to 0, or to the distant lights that are seen there.
    VkBool32 background;
    CndLobeJoining lobes;
    // Light that bounces between microfacets is given back (Turquin 2019): without, a white metal
    // loses up to 69% of it.
    VkBool32 energyCompensation;
    VkDescriptorSet hostSet; // as of CndLightingFrame
} CndEnvironmentFrame;

typedef struct CndEnvironmentStats {
    uint32_t structSize;
    uint32_t kernelTimeCount; // of the frame; 0 without timestamps
    CndKernelTime kernelTimes[CND_MAX_KERNEL_TIMES];
    uint32_t mapKernelTimeCount; // of the last cndRecordEnvironmentMap
    CndKernelTime mapKernelTimes[CND_MAX_KERNEL_TIMES];
} CndEnvironmentStats;

// What creation will take: exactly that, with nothing allocated. Fails like it.
CND_API CndResult cndPlanEnvironment(const CndDeviceDesc* device, const CndEnvironmentDesc* desc,
                                     CndMemoryUsage* usage, CndError* error);
CND_API CndResult cndCreateEnvironment(const CndDeviceDesc* device, const CndEnvironmentDesc* desc,
                                       CndEnvironment* environment, CndError* error);
CND_API void cndDestroyEnvironment(CndEnvironment environment);
// What it holds, from creation on.
CND_API CndResult cndGetEnvironmentMemory(CndEnvironment environment, CndMemoryUsage* usage,
                                          CndError* error);
// Records what shading needs of an image: cube, prefiltered cube, irradiance (and, the first time,
// the table of the specular lobe's albedo). The GPU must have finished all that was recorded with
// the object before. Submitted before the frames that use it, to the same queue. Changes compute
// pipeline, compute descriptor set 0 and push constants; must be outside a render pass.
CND_API CndResult cndRecordEnvironmentMap(CndEnvironment environment, VkCommandBuffer cmd,
                                          const CndEnvironmentMap* map, CndError* error);
// Records shading of one frame: one kernel. Specular by split sum: exact in surroundings of one
// luminance, else the lobe has the shape it has when seen from above. No shadows.
CND_API CndResult cndRecordEnvironment(CndEnvironment environment, VkCommandBuffer cmd,
                                       const CndEnvironmentFrame* frame, CndError* error);
// Times of the last frame recorded in frameSlot and of the last map; CND_NOT_READY until the GPU
// has finished them, CND_ERROR_INVALID_ARGUMENT before the first.
CND_API CndResult cndGetEnvironmentStats(CndEnvironment environment, uint32_t frameSlot,
                                         CndEnvironmentStats* stats);

#ifdef __cplusplus
}
#endif
#endif
