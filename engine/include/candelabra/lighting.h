// SPDX-License-Identifier: Apache-2.0
// The lighting module: culls lights into lists and shades the surfaces of a view.
#ifndef CANDELABRA_LIGHTING_H
#define CANDELABRA_LIGHTING_H

#include "candelabra/core.h"
#include "candelabra/exposure.h"
#include "candelabra/lights.h"
#include "candelabra/surfaces.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct CndLighting_T* CndLighting; // pipelines and one light set, shared by its views
typedef struct CndLightingView_T* CndLightingView; // buffers of one view

// How the specular lobe of sphere lights is evaluated; `candelabra bench accuracy` measures time
// and error of each. Tubes, rectangles and discs use a representative point with POINT, KARIS and
// KX and linearly transformed cosines with LTC, CONIC and CONIC_FULL.
typedef enum CndSpecularMethod {
    CND_SPECULAR_NONE = 0,  // diffuse only
    CND_SPECULAR_KARIS = 1, // normalised representative point (Karis 2013)
    CND_SPECULAR_POINT = 2, // all light from the centre
    CND_SPECULAR_KX = 3,    // representative point, unwidened lobe, exact normalisation of its peak
    CND_SPECULAR_LTC = 4,   // linearly transformed cosines (Heitz, Dupuy, Hill, Neubelt 2016)
    CND_SPECULAR_CONIC = 5, // slope-conic closed form; two shading nodes near the horizon
    CND_SPECULAR_CONIC_FULL = 6, // slope-conic, two shading nodes everywhere
    CND_SPECULAR_SAMPLED = 7,    // stochastic: CndLightingFrame::sampleCount samples per light
    CND_SPECULAR_METHOD_COUNT = 8,
    CND_SPECULAR_METHOD_MAX_ENUM = 0x7FFFFFFF
} CndSpecularMethod;

typedef enum CndCulling {
    CND_CULLING_CLUSTERED = 0, // exact lists for clusters of surface samples
    CND_CULLING_BRUTE = 1, // every light at every pixel, no list, no bound; the check and baseline
    CND_CULLING_MAX_ENUM = 0x7FFFFFFF
} CndCulling;

// How far lights reach that have a place. Distant lights reach everything.
typedef enum CndInfluenceRule {
    // CndLight::influenceRadius, with a window that takes the light smoothly to 0 there:
    // (1 - (d / r)^4)^2.
    CND_INFLUENCE_GIVEN = 0,
    CND_INFLUENCE_UNCUT = 1, // everywhere, as light does; influenceRadius need only be valid
    // As far as the display can tell, by CndInfluence::maxError; influenceRadius need only be
    // valid. A light of peak intensity I (cd) gets the radius sqrt(I / E) and the window of GIVEN,
    // E one illuminance for all lights, chosen on the device with every frame. The error of a pixel
    // counts all that cuts and windows of all lights together take from it. The first frame, and
    // the first with another maxError, measures every pixel (of images larger than 1024x1024 at
    // least 260,000) and takes about as long as brute force. The others measure up to 4096 pixels,
    // one of each NxN and each time another: N is 8, or 16, 32, 64 ... in images larger than 0.26,
    // 1.0, 4.2 ... million pixels. E falls at once where they ask for it; it rises, by half an
    // octave per frame, to what the last full turn of N^2 frames has allowed. What comes into view
    // may so err by more in a few pixels until their turn comes. Tiles are not split in depth and
    // lists are made anew in every frame. CND_CULLING_BRUTE, the check, cuts nothing.
    CND_INFLUENCE_BY_ERROR = 2,
    CND_INFLUENCE_RULE_MAX_ENUM = 0x7FFFFFFF
} CndInfluenceRule;

typedef struct CndInfluence {
    CndInfluenceRule rule;
    // The rest is read by CND_INFLUENCE_BY_ERROR.
    // Largest change of an sRGB-encoded channel of 0..1 that lights may miss on the display:
    // 0 < maxError <= 1; 0.5 / 255 cannot change an 8-bit level by more than one.
    float maxError;
    // CndExposureStats::exposure of an earlier frame, >= 0; 0: none is known yet, the frame is
    // UNCUT.
    float exposure;
    CndToneMap toneMap; // as in CndExposureSettings
} CndInfluence;

// How a pixel finds its lights (CndLightingFrame::pairImage). Of several light types the highest.
typedef enum CndPixelClass {
    CND_PIXEL_NO_SURFACE = 0,
    CND_PIXEL_OF_TILE = 1,  // one list for all of its 8x8 pixel tile
    CND_PIXEL_OF_SLICE = 2, // the tile is deep: a list per slice of depth
    CND_PIXEL_UNLISTED = 3, // no room for the list, or too long: walks the light tree
    CND_PIXEL_CLASS_MAX_ENUM = 0x7FFFFFFF
} CndPixelClass;

// Materials without one of the two lobes (CndLightingDesc::materialClasses).
typedef enum CndMaterialClass {
    CND_MATERIAL_DIFFUSE_ONLY = 1,  // F0 and F90 are 0
    CND_MATERIAL_SPECULAR_ONLY = 2, // the diffuse albedo is 0: metals
    CND_MATERIAL_CLASS_MAX_ENUM = 0x7FFFFFFF
} CndMaterialClass;

typedef struct CndLightingDesc {
    uint32_t structSize;
    uint32_t framesInFlight; // 1..8: frames the host may have recorded or submitted and not yet
                             // waited for
    CndGBufferLayout gbufferLayout;
    // Time every kernel: one timestamp more than there are dispatches, about 50 us each on a
    // software device; off records none.
    VkBool32 timestamps;
    // Mask of 1 << CndSpecularMethod: what frames may ask for; 0: CND_SPECULAR_CONIC. Pipelines are
    // made for these only; those of a light type with the first set of lights that holds it
    // (spheres: at creation).
    uint32_t specularMethods;
    CndGBufferDesc gbuffer; // of CND_GBUFFER_HOST
    // VK_SHADER_STAGE_VERTEX_BIT, _FRAGMENT_BIT and _COMPUTE_BIT: shaders of the host's that light
    // things by themselves (cndGetForwardSet); 0: none.
    VkShaderStageFlags forwardStages;
    // Mask of CndMaterialClass, 0: none. 8x8 pixel tiles that hold such surfaces alone are shaded
    // by pipelines that leave the missing lobe out: the same image but for rounding. For scenes
    // that have such materials: elsewhere every tile is looked at in vain, and each class has
    // pipelines of its own for every light type. Layouts that cannot store an F90 of 0 have no
    // diffuse class. With hostKernels the diffuse class needs those of CND_SPECULAR_NONE as well.
    uint32_t materialClasses;
    CndHostKernels hostKernels; // must hold all that light types, methods and layout need
    // What creation makes ready. Sets within both need no more memory (but for staging buffers, see
    // cndSetLights) and no more pipelines.
    uint32_t lightCapacity; // lights; 0: 1024. Larger sets make it grow, by half at least
    uint32_t lightTypes;    // mask of 1 << CndLightType; 0: pipelines for spheres only
    // Frames may ask for CND_INFLUENCE_BY_ERROR: makes the pipelines that measure it, and views
    // take up to 2.1 MB more. Not with hostKernels, whose functions those do not have.
    VkBool32 influenceByError;
} CndLightingDesc;

typedef struct CndLightingViewDesc {
    uint32_t structSize;
    uint32_t maxWidth, maxHeight; // pixels, 1..16384; frames may be smaller
    // Bytes for the light lists of a frame, 0 = default (64 MiB). Clusters whose list does not fit
    // are shaded by walking the light tree: slower, never wrong, and counted in
    // CndLightingStats::unlistedClusters.
    VkDeviceSize listBudget;
} CndLightingViewDesc;

// One frame of one view.
// On entry: normalRoughness, albedo, specular and depth in
// VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, radiance in VK_IMAGE_LAYOUT_GENERAL, all made visible
// to COMPUTE_SHADER (SHADER_SAMPLED_READ, and SHADER_STORAGE_READ | SHADER_STORAGE_WRITE for
// radiance). On exit: layouts unchanged, radiance written by COMPUTE_SHADER / SHADER_STORAGE_WRITE,
// not yet made visible.
typedef struct CndLightingFrame {
    uint32_t structSize;
    uint32_t frameSlot; // 0..framesInFlight-1; the GPU must have finished the slot's previous frame
    uint32_t width, height; // pixels, 1..max of the view
    CndCamera camera;
    float clearDepth; // depth of pixels without a surface: 0 with reversed depth, else 1
    VkImageView normalRoughness;
    VkImageView albedo;
    VkImageView specular; // may be VK_NULL_HANDLE where the layout reads none (COMPACT)
    VkImageView depth;    // depth aspect of a depth format, or R32_SFLOAT
    VkImageView radiance; // R32G32B32A32_SFLOAT, storage; outgoing luminance is ADDED (cd/m^2)
    CndSpecularMethod specularMethod; // one of CndLightingDesc::specularMethods; 0 is NONE
    uint32_t sampleCount; // CND_SPECULAR_SAMPLED: samples per light and pixel, 1..4096; 0: 64
    uint32_t sampleSeed;  // CND_SPECULAR_SAMPLED: same seed, same image
    // 0: every light in full. Else lights are evaluated as cheaply as an a-priori bound of the
    // error allows: at most about this share of the highest response to the light (0.01: 1%). 0..1.
    float errorBudget;
    CndLobeJoining lobes;
    // Give back what single-bounce microfacets lose (Turquin 2019): a white metal then reflects all
    // light at any roughness.
    VkBool32 energyCompensation;
    CndCulling culling;
    // With BY_ERROR radiance holds, on entry, all light of the image that is not of these lights.
    CndInfluence influence;
    // The host promises: size, camera, clearDepth, depth and normals are those of the frame
    // recorded with this view before, and so are albedo and specular with materialClasses. With the
    // same lights and influence too, its clusters and lists are used again.
    VkBool32 surfacesUnchanged;
    VkRect2D bruteRect;  // CND_CULLING_BRUTE: pixels to shade; zero extent: all
    VkBool32 countPairs; // also count (pixel, light) pairs: one more kernel; clustered only
    // With countPairs, or VK_NULL_HANDLE: what every pixel costs. R32G32B32A32_SFLOAT, storage,
    // layout and visibility as of radiance. ADDED: r lights of its list, g lights evaluated (turns
    // in which it waits for its neighbours included), b lights that contribute. a becomes a
    // CndPixelClass, 0 stays without a surface.
    VkImageView pairImage;
    // Mask of 1 << layer, below CND_LAYER_COUNT; 0: all. Lights that have none of them light
    // nothing in this frame, nor in shaders of cndGetForwardSet: no list holds them, brute force
    // skips them.
    uint32_t layers;
    // Of CndLightingDesc::hostKernels, if these have a set layout: bound as descriptor set 1. The
    // host makes what it reads visible to COMPUTE_SHADER.
    VkDescriptorSet hostSet;
} CndLightingFrame;

// What cndRecordSurfaceOverlay shows, black where there is no surface.
typedef enum CndSurfaceQuantity {
    CND_SURFACE_ALL = 0,       // the six below, small: three beside each other, above three
    CND_SURFACE_NORMAL = 1,    // 0.5 + 0.5 * normal, world space
    CND_SURFACE_ROUGHNESS = 2, // perceptual; white: 1
    CND_SURFACE_ALBEDO = 3,    // diffuse, sRGB-encoded
    CND_SURFACE_F0 = 4,        // sRGB-encoded
    // World position: red, green and blue rise and fall again every two metres of x, y and z. Fixed
    // to the surfaces when the camera moves, unless depth or matrices are read wrongly.
    CND_SURFACE_POSITION = 5,
    // Grey, the darker the more grazing the view, with what cannot be right on top: magenta, a NaN
    // or infinite value; blue, a position that is not in front of the eye; yellow, a normal that
    // was not of length 1, by 2%; red, one that faces away from the eye by more than 10 degrees;
    // cyan, roughness outside 0..1; orange, albedo or F0 outside 0..1.
    CND_SURFACE_FAULTS = 6,
    CND_SURFACE_QUANTITY_MAX_ENUM = 0x7FFFFFFF
} CndSurfaceQuantity;

// On entry: image in VK_IMAGE_LAYOUT_GENERAL, visible to COMPUTE_SHADER / SHADER_STORAGE_WRITE. On
// exit: the same layout, written by COMPUTE_SHADER / SHADER_STORAGE_WRITE.
typedef struct CndSurfaceOverlay {
    uint32_t structSize;
    CndSurfaceQuantity quantity;
    VkImageView image; // R8G8B8A8_UNORM, storage; to be shown like CndExposureFrame::display
} CndSurfaceOverlay;

typedef struct CndLightingStats {
    uint32_t structSize;
    uint32_t lightCount;     // of the set, of all layers, CndDeviceLights::maxCount included
    uint32_t deviceLights;   // taken from CndDeviceLights
    uint32_t rejectedLights; // in CndDeviceLights, but outside the range of a field, or too many
    // By type, CndDeviceLights::maxCount included; types without lights have no passes.
    uint32_t lightTypeCounts[CND_LIGHT_TYPE_COUNT];
    uint32_t tileCount;      // 8x8 pixel tiles that hold a surface; 0 without lights in view
    uint32_t splitTileCount; // of these, deep ones whose slices of depth have a list each
    uint32_t diffuseTileCount, specularTileCount; // of CndLightingDesc::materialClasses
    uint32_t listEntries;                         // lights of all lists
    uint32_t maxListLength;                       // of one cluster and light type
    // Clusters over the list budget, or of more lights than a loop of the device may take, summed
    // over light types: lit by walking the light tree per pixel.
    uint32_t unlistedClusters;
    // CND_INFLUENCE_BY_ERROR: the illuminance (lx) that lights are cut at; 0: none is.
    float cutBelow;
    // (pixel, light) pairs of clusters that have lists, with countPairs, else 0:
    // Entries walked, summed over the surface pixels; distant lights of other layers are walked,
    // and counted here alone.
    uint64_t listedPairs;
    uint64_t evaluatedPairs;    // lanes that evaluate a light, those that wait for others included
    uint64_t insidePairs;       // listed and distance < influence radius
    uint64_t contributingPairs; // of those, emitter not wholly below the horizon
    uint32_t kernelTimeCount;   // 0 without timestamps
    CndKernelTime kernelTimes[CND_MAX_KERNEL_TIMES];
    uint32_t passCount; // all the module has, in order
    CndPassPlan passes[CND_MAX_PASSES];
} CndLightingStats;

// What creating a module, and `viewCount` views of it, will take, before any of it exists: exactly
// that, with nothing allocated. Light sets within lightCapacity and lightTypes take no more but for
// staging buffers. Fails like creation.
CND_API CndResult cndPlanLighting(const CndDeviceDesc* device, const CndLightingDesc* desc,
                                  uint32_t viewCount, const CndLightingViewDesc* views,
                                  CndMemoryUsage* usage, CndError* error);
CND_API CndResult cndCreateLighting(const CndDeviceDesc* device, const CndLightingDesc* desc,
                                    CndLighting* lighting, CndError* error);
// The GPU must have finished all work recorded with the object or its views; views go first.
CND_API void cndDestroyLighting(CndLighting lighting);
// What the module and its views hold now, with what waits for frames in flight to be finished.
CND_API CndResult cndGetLightingMemory(CndLighting lighting, CndMemoryUsage* usage,
                                       CndError* error);

// Validates and packs the lights; takes effect at the next recording. Their ids are their indices;
// those of the set before are gone. On error the previous set stays. Allocates when there are more
// lights than room was made for, and makes pipelines and lists when a light type is new. Lights go
// to the device from a staging buffer of 64 bytes per light of the capacity, with one more for
// each frame in flight that still reads another.
CND_API CndResult cndSetLights(CndLighting lighting, const CndLightSet* set, CndError* error);

// Edits of the set, for sets of which few lights change: only these are validated, packed and
// uploaded, 64 bytes each. They take effect at the next recording, which sorts the set on the
// device again. Lights on the device are not read again. On error nothing has changed. May allocate
// when the set grows, and make pipelines when a light type is new. The same calls give the same
// image, bit for bit, and it is that of the same lights given at once but for rounding: lights of
// one place and size add up in an order that follows the edits.

// Adds `count` lights, to none when no set was given, around the origin of the set, and writes
// their ids.
CND_API CndResult cndAddLights(CndLighting lighting, uint32_t count, const CndLight* lights,
                               CndLightId* ids, CndError* error);
// Replaces the lights with these ids, no id twice, each by any light.
CND_API CndResult cndUpdateLights(CndLighting lighting, uint32_t count, const CndLightId* ids,
                                  const CndLight* lights, CndError* error);
// Removes the lights with these ids, no id twice.
CND_API CndResult cndRemoveLights(CndLighting lighting, uint32_t count, const CndLightId* ids,
                                  CndError* error);

CND_API CndResult cndCreateLightingView(CndLighting lighting, const CndLightingViewDesc* desc,
                                        CndLightingView* view, CndError* error);
// The GPU must have finished all work recorded with the view.
CND_API void cndDestroyLightingView(CndLightingView view);

// Records culling and shading. Changes compute pipeline, compute descriptor sets 0 and 1 and push
// constants; must be outside a render pass. Lights travel in the first recording after they
// change, so recordings of all views of one CndLighting are submitted once each, in their
// order, to one queue.
CND_API CndResult cndRecordLighting(CndLightingView view, VkCommandBuffer cmd,
                                    const CndLightingFrame* frame, CndError* error);

// Records a picture of what the module reads out of the host's G-buffer, to find mistakes of the
// integration. `frame` as for cndRecordLighting, of which frameSlot, size, camera, clearDepth and
// the G-buffer are used. At most once per frame and slot; changes and needs what cndRecordLighting
// does, which need not be recorded.
CND_API CndResult cndRecordSurfaceOverlay(CndLightingView view, VkCommandBuffer cmd,
                                          const CndLightingFrame* frame,
                                          const CndSurfaceOverlay* overlay, CndError* error);

// --- Lights in shaders of the host's: transparent surfaces, particles, volumes. Not without
// CndLightingDesc::forwardStages. The shaders include lib/forward.glsl of the installed shaders,
// which shades with CND_SPECULAR_CONIC and the lobes of the frame, at any position that the frame's
// camera shows.

// The layout of the set, for pipeline layouts: storage buffers and uniform texel buffers at
// bindings of its own. Lives as long as the module.
CND_API CndResult cndGetForwardSetLayout(CndLighting lighting, VkDescriptorSetLayout* layout,
                                         CndError* error);
// The set that holds the lights of the last frame recorded in frameSlot, to be bound behind that
// recording, in the same queue, until the slot or any other frame of the view is recorded: there is
// one copy of the lights. The same handle each time, and as long as the view. cndRecordLighting
// waits for shaders of forwardStages before it writes, and makes what it wrote visible to them: the
// host adds no barrier.
CND_API CndResult cndGetForwardSet(CndLightingView view, uint32_t frameSlot, VkDescriptorSet* set,
                                   CndError* error);

// Statistics of the last frame recorded in frameSlot; CND_NOT_READY until the GPU has finished it,
// which a lost device never does (CND_ERROR_DEVICE where timestamps tell).
CND_API CndResult cndGetLightingStats(CndLightingView view, uint32_t frameSlot,
                                      CndLightingStats* stats);

#ifdef __cplusplus
}
#endif
#endif
