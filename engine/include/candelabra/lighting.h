// SPDX-License-Identifier: Apache-2.0
// The lighting module: finds the lights that reach each surface of a view, and shades with them.
#ifndef CANDELABRA_LIGHTING_H
#define CANDELABRA_LIGHTING_H

#include "candelabra/core.h"
#include "candelabra/exposure.h"
#include "candelabra/lights.h"
#include "candelabra/surfaces.h"

#ifdef __cplusplus
extern "C" {
#endif

// Pipelines and one light set, shared by all its views.
typedef struct CndLighting_T* CndLighting;
// Buffers of one view: light lists, counters.
typedef struct CndLightingView_T* CndLightingView;

// How the specular lobe of sphere lights is evaluated. `candelabra bench accuracy` measures time
// and error of each method. Other lights have fewer methods. Area lights of other shapes (tubes,
// rectangles, discs, polygons) use a closed form along their outlines with CONIC and CONIC_FULL, a
// representative point with POINT, KARIS and KX, and samples with SAMPLED. Point, spot and
// directional lights need no approximation: every method but NONE evaluates them exactly.
typedef enum CndSpecularMethod {
    // In a frame: the method with the smallest value in CndLightingDesc::specularMethods. Masks of
    // methods must not hold it.
    CND_SPECULAR_DEFAULT = 0,
    CND_SPECULAR_NONE = 1,  // no specular lobe, diffuse only
    CND_SPECULAR_KARIS = 2, // representative point, normalised for a widened lobe (Karis 2013)
    CND_SPECULAR_POINT = 3, // the sphere is treated as a point at its centre
    CND_SPECULAR_KX = 4,    // representative point, normalised for the exact peak of the lobe
    // Closed form for spheres, derived in slope space, where a conic bounds the sphere. It
    // integrates the GGX distribution exactly. It evaluates microfacet shadowing and Fresnel at two
    // directions if the sphere is near the horizon, and at one direction otherwise.
    CND_SPECULAR_CONIC = 5,
    // The same closed form. It always evaluates shadowing and Fresnel at two directions.
    CND_SPECULAR_CONIC_FULL = 6,
    CND_SPECULAR_SAMPLED = 7, // Monte Carlo: CndLightingFrame::sampleCount samples per light and
                              // pixel
    CND_SPECULAR_METHOD_COUNT = 8, // one more than the largest value
    CND_SPECULAR_METHOD_MAX_ENUM = 0x7FFFFFFF
} CndSpecularMethod;

// How the lights of a pixel are found.
typedef enum CndCulling {
    // Light lists for clusters of surface samples. A list may hold lights that add nothing to a
    // sample of its cluster. It never lacks a light that does.
    CND_CULLING_CLUSTERED = 0,
    // Every light at every pixel, without lists and bounds, for checks and as a baseline. Windows
    // of influenceRadius still apply.
    CND_CULLING_BRUTE = 1,
    CND_CULLING_MAX_ENUM = 0x7FFFFFFF
} CndCulling;

// How far lights with a position reach. Distant lights reach everything.
typedef enum CndInfluenceRule {
    // Each light reaches CndLight::influenceRadius r. A window fades it smoothly to 0 there: (1 -
    // (d / r)^4)^2 at distance d.
    CND_INFLUENCE_GIVEN = 0,
    // Every light reaches everything, as real light does. influenceRadius must be valid but is
    // ignored. Tiles are not split in depth with this rule.
    CND_INFLUENCE_UNCUT = 1,
    // Each light reaches only so far that cutting all lights there changes the display value of a
    // measured pixel by at most CndInfluence::maxError. influenceRadius must be valid but is
    // ignored.
    //
    // A light of peak intensity I (cd) gets the radius sqrt(I / E) and the window of
    // CND_INFLUENCE_GIVEN. E is one illuminance for all lights, which the device chooses in every
    // frame. The error of a pixel is the change of its display value when all lights are cut and
    // windowed at once.
    //
    // The first frame, and the first frame with another maxError, measures every pixel (in images
    // larger than 1024x1024 at least 260,000 pixels) and takes about as long as brute force. Other
    // frames measure up to 4096 pixels: one of each NxN, and in each frame a different one. N is 8,
    // or 16, 32, 64 ... in images of more than 0.26, 1.0, 4.2 ... million pixels.
    //
    // E falls at once when a measured pixel demands it. It rises by one step per frame (half an
    // octave; two octaves for the lowest values). It rises at most to the highest value that all
    // pixels allowed when they were measured in the last full round of N^2 frames. So the error of
    // a few pixels that have just come into view may be larger until they are measured.
    //
    // With this rule, tiles are not split in depth, and lists are rebuilt in every frame. Frames
    // with CND_CULLING_BRUTE ignore the rule: every light reaches everything there.
    CND_INFLUENCE_BY_ERROR = 2,
    CND_INFLUENCE_RULE_MAX_ENUM = 0x7FFFFFFF
} CndInfluenceRule;

// The influence rule of a frame. All members but `rule` are read with CND_INFLUENCE_BY_ERROR only.
typedef struct CndInfluence {
    CndInfluenceRule rule;
    // The largest error that cut lights may cause on the display, in an sRGB-encoded channel of
    // 0..1: 0 < maxError <= 1. With 0.5 / 255 an 8-bit value changes by at most one step.
    float maxError;
    // CndExposureStats::exposure of an earlier frame, finite and >= 0. 0 means that none is known
    // yet: the frame then behaves as with CND_INFLUENCE_UNCUT.
    float exposure;
    CndToneMap toneMap; // tone map that displays the frame, as in CndExposureSettings
} CndInfluence;

// How a pixel finds its lights (CndLightingFrame::pairImage). If this differs between light types,
// the highest value counts.
typedef enum CndPixelClass {
    CND_PIXEL_NO_SURFACE = 0,
    CND_PIXEL_OF_TILE = 1,  // one light list for all of the 8x8 pixel tile
    CND_PIXEL_OF_SLICE = 2, // the tile is deep and has a light list for each slice of depth
    CND_PIXEL_UNLISTED = 3, // its cluster has no list, because the list budget was used up or the
                            // list was too long: the pixel walks the light tree
    CND_PIXEL_CLASS_MAX_ENUM = 0x7FFFFFFF
} CndPixelClass;

// The pipelines that frames need in addition to those of a specular method and of light types.
// Every frame needs one of the first two bits. CND_SHADING_COUNT_PAIRS_BIT is in addition to the
// first.
typedef enum CndShadingBits {
    CND_SHADING_CLUSTERED_BIT = 1,   // CND_CULLING_CLUSTERED
    CND_SHADING_BRUTE_BIT = 2,       // CND_CULLING_BRUTE
    CND_SHADING_COUNT_PAIRS_BIT = 4, // countPairs with CND_CULLING_CLUSTERED
    CND_SHADING_BITS_MAX_ENUM = 0x7FFFFFFF
} CndShadingBits;

// Soft shadows of the host's occluders (occluders.h), or of what rays of the host hit
// (CND_HOST_VISIBLE_POINTS_BIT, compiler.h).
typedef struct CndShadowDesc {
    // 0 (no shadows), 32 or 64: how many points of each light a pixel asks for. 64 cost little
    // more. With points the device needs maxPerStageDescriptorStorageBuffers of 13, and depth must
    // have at least 24 bits: CndGBufferDesc::depthFormat is D24, D32 or a format of 32-bit floats.
    // If it is VK_FORMAT_UNDEFINED, depth is taken for 32-bit floats.
    uint32_t points;
    // Room that creation makes, for triangles of all meshes and for instances; more is allocated
    // when needed.
    uint32_t triangleCapacity, instanceCapacity;
} CndShadowDesc;

typedef struct CndLightingDesc {
    uint32_t structSize;
    uint32_t framesInFlight; // 1..8: frames that the host may have recorded or submitted and not
                             // yet waited for
    CndGBufferLayout gbufferLayout;
    // VK_TRUE: measure the GPU time of every pass. A frame then writes one timestamp at its start
    // and one at the end of every pass. The next pass waits there anyway, so dispatches that may
    // run at the same time still do. The time of a pass includes its waits for barriers. A
    // timestamp takes about 50 us on a software device.
    VkBool32 timestamps;
    // Mask of 1 << CndSpecularMethod: the methods that frames may ask for; 0: CND_SPECULAR_CONIC
    // alone. Pipelines are created for these methods only. cndCreateLighting creates the pipelines
    // of spheres and of the types in lightTypes. Those of any other type are created when a light
    // set first contains the type. cndAddLightingPipelines adds methods and types later, so a
    // module that begins with few of them is created sooner.
    uint32_t specularMethods;
    // Mask of CndShadingBits: what frames may ask for; 0: all of it. With CND_SHADING_CLUSTERED_BIT
    // alone, creation makes about half of the pipelines of CND_SPECULAR_CONIC that it makes with
    // all bits. cndAddLightingPipelines adds the rest later.
    uint32_t shading;
    CndGBufferDesc gbuffer;
    // Format of the frames' radiance images: R32G32B32A32_SFLOAT (VK_FORMAT_UNDEFINED, 0, means
    // this), R16G16B16A16_SFLOAT or, on devices that can read and write it as a storage image
    // without a format in the shader, B10G11R11_UFLOAT_PACK32. Each light type adds its light with
    // one rounding to the format. Luminance beyond the range of the two smaller formats is stored
    // as the largest value that they can hold, 65,504 and 64,512 cd/m^2.
    VkFormat radianceFormat;
    // Format of CndSurfaceOverlay::image, one of those of CndExposureDesc::displayFormat;
    // VK_FORMAT_UNDEFINED (0) means R8G8B8A8_UNORM.
    VkFormat overlayFormat;
    // Stages (VK_SHADER_STAGE_VERTEX_BIT, _FRAGMENT_BIT, _COMPUTE_BIT) of the host's own shaders
    // that evaluate lights through cndGetForwardSet; 0: there are none.
    VkShaderStageFlags forwardStages;
    // VK_TRUE: 8x8 pixel tiles in which no surface has a specular lobe (F0 and F90 are 0) are
    // shaded by pipelines without it. The image differs only by rounding. Use it only for scenes
    // that have such materials: it takes time to inspect the tiles in every frame, and these
    // pipelines are made for every light type. Layouts that cannot store an F90 of 0 have no such
    // tiles. With hostKernels it also needs the kernels of CND_SPECULAR_NONE.
    VkBool32 diffuseOnlyTiles;
    // Kernels with functions of the host. If there are any, they must include every kernel that
    // evaluates lights for the light types and methods in use; with CND_GBUFFER_CUSTOM they must
    // include every kernel in use that reads the G-buffer.
    CndHostKernels hostKernels;
    // Number of lights that creation makes room for; 0: 1024. A larger light set makes the capacity
    // grow by at least half. Light sets within lightCapacity and lightTypes need no more memory
    // (except for staging buffers, see cndSetLights) and no more pipelines.
    uint32_t lightCapacity;
    // Light types that creation makes pipelines and list buffers for, a mask of 1 << CndLightType.
    // Spheres have their pipelines in any case.
    uint32_t lightTypes;
    // VK_TRUE: frames may use CND_INFLUENCE_BY_ERROR. The pipelines that measure the error are
    // created, and each view takes up to 2.1 MB more. Not allowed with hostKernels: the measuring
    // kernels do not contain the host's functions.
    VkBool32 influenceByError;
    CndShadowDesc shadows; // all zero: nothing is allocated, compiled or run for shadows
} CndLightingDesc;

typedef struct CndLightingViewDesc {
    uint32_t structSize;
    uint32_t maxWidth, maxHeight; // pixels, 1..16384: the largest frame of the view; frames may be
                                  // smaller
    // Bytes for the light lists of a frame, 0: default, 64 MiB (less if the device's
    // maxStorageBufferRange is smaller). Clusters whose lists do not fit are shaded by walking the
    // light tree. This is slower and gives the same image except for rounding.
    // CndLightingStats::unlistedClusters counts these clusters. The sums of long lists take a ninth
    // as much memory, which is not part of the budget.
    VkDeviceSize listBudget;
    // Bytes for what pixels see of lights, with CndLightingDesc::shadows. Every light on the list
    // of a cluster takes 256 of them, unless it is seen wholly or is proven to be hidden. Each 256
    // bytes take 112 more beside the budget, among them records for four lights on lists. Clusters
    // for which there is no room are shaded by walking the light tree, as those without a list. The
    // view allocates 256 bytes more per 8x8 pixel tile of the largest frame, which is room for one
    // distant light. 0: default, 128 MiB, less if the sum exceeds the device's
    // maxStorageBufferRange. A larger budget leaves less room for distant lights.
    VkDeviceSize shadowBudget;
} CndLightingViewDesc;

// One frame of one view.
//
// On entry: normalRoughness, albedo, specular and depth are in
// VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL (or as gbufferImageLayout and depthImageLayout say),
// radiance is in VK_IMAGE_LAYOUT_GENERAL, and all are visible to COMPUTE_SHADER
// (SHADER_SAMPLED_READ, for radiance SHADER_STORAGE_READ | SHADER_STORAGE_WRITE). On exit: layouts
// are unchanged; radiance has been written by COMPUTE_SHADER / SHADER_STORAGE_WRITE and is not yet
// made visible.
typedef struct CndLightingFrame {
    uint32_t structSize;
    uint32_t frameSlot; // 0..framesInFlight-1; the GPU must have finished the slot's previous frame
    // The frame is a rectangle of its images: x and y are its top left pixel, for example that of a
    // half of a split screen or of a tile of an atlas. x + width and y + height are at most 16384
    // and inside every image, which the module cannot check. clipFromView is the projection of the
    // rectangle alone, and bruteRect counts from its corner. The lit pixels have the same bits
    // wherever the rectangle lies.
    uint32_t x, y;
    uint32_t width, height; // pixels, 1..maxWidth and 1..maxHeight of the view
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
    // One of CndLightingDesc::specularMethods, or one that was added since; 0:
    // CND_SPECULAR_DEFAULT.
    CndSpecularMethod specularMethod;
    // With CND_SPECULAR_SAMPLED: samples per light and pixel, 1..4096; 0: 64.
    uint32_t sampleCount;
    // With CND_SPECULAR_SAMPLED: the same seed gives the same image.
    uint32_t sampleSeed;
    CndLobeJoining lobes;
    // VK_TRUE: compensate the energy that single-scattering microfacet models lose to multiple
    // bounces (Turquin 2019). A white metal then reflects all light at any roughness.
    VkBool32 energyCompensation;
    CndCulling culling;
    // With CND_INFLUENCE_BY_ERROR, `radiance` must hold all other light of the image on entry,
    // because the error depends on the sum.
    CndInfluence influence;
    // With VK_TRUE the host promises that size, camera, clearDepth, depth and normals are those of
    // the previous frame recorded with this view, with CndLightingDesc::shadows also roughness, and
    // with diffuseOnlyTiles also albedo and specular. The clusters and lists of that frame are then
    // reused if the light set, occluders, layers, specularMethod, sampleCount, influence.rule and
    // shadowsOff are also the same and both frames use CND_CULLING_CLUSTERED. So is what pixels see
    // of lights, unless rays of the host find it, because what they hit may have moved, or there is
    // no room for all distant lights in view (shadowBudget). Only hosts' shaders and the pixels of
    // unlistedClusters then look for shadows. With CND_INFLUENCE_BY_ERROR nothing is ever reused.
    VkBool32 surfacesUnchanged;
    // With CND_CULLING_BRUTE: the pixels to shade; zero extent: all pixels. No dispatch evaluates
    // more than 2^28 pairs of pixel and light (with more than four million lights: the pairs of 64
    // pixels), so none runs for seconds. If the system also limits how long a submission runs,
    // record the frame as several frames with one rectangle each, and submit each separately. The
    // image has the same bits.
    VkRect2D bruteRect;
    // VK_TRUE: also count (pixel, light) pairs, with one more kernel. Ignored with
    // CND_CULLING_BRUTE.
    VkBool32 countPairs;
    // With countPairs: receives the cost of every pixel, or is VK_NULL_HANDLE. An
    // R32G32B32A32_SFLOAT storage image, with layout and visibility as for radiance. ADDED to it:
    // in r the lights on the pixel's lists, in g the iterations of the loops that evaluate lights
    // (including iterations in which the pixel only waits for others of its subgroup), in b the
    // lights that contribute. a becomes the pixel's CndPixelClass if that is higher. Pixels without
    // a surface are left alone.
    VkImageView pairImage;
    // With countPairs and CndLightingDesc::shadows: receives the shadows of every pixel, or is
    // VK_NULL_HANDLE. An image as pairImage. ADDED to it: in r the lights whose visibility the
    // pixel asked for, in g those of which it sees a part, in b those of which it sees nothing.
    // Pixels do not ask for CndLightingStats::litEntries and hiddenEntries, so where all lights are
    // seen wholly or proven to be hidden, it adds 0. Lights of clusters without a list are not
    // counted. Brute force writes nothing to it.
    VkImageView shadowImage;
    // VK_TRUE: the frame has no shadows. Ignored without CndLightingDesc::shadows.
    VkBool32 shadowsOff;
    // Mask of 1 << layer, layer < CND_LAYER_COUNT; 0: all layers. Lights that share no layer with
    // this mask do not exist in this frame, nor for shaders that use its forward set. Lists do not
    // contain them, and brute force skips them.
    uint32_t layers;
    // The host's descriptor set 1, of layout CndHostKernels::setLayout, if
    // CndLightingDesc::hostKernels use one. The host makes what the set refers to visible to
    // COMPUTE_SHADER.
    VkDescriptorSet hostSet;
} CndLightingFrame;

// What cndRecordSurfaceOverlay shows. Pixels without a surface are black.
typedef enum CndSurfaceQuantity {
    CND_SURFACE_ALL = 0,       // the six quantities below as small pictures, in two rows of three
    CND_SURFACE_NORMAL = 1,    // 0.5 + 0.5 * normal, in world space
    CND_SURFACE_ROUGHNESS = 2, // perceptual roughness; 1 is white
    CND_SURFACE_ALBEDO = 3,    // diffuse albedo, sRGB-encoded
    CND_SURFACE_F0 = 4,        // F0, sRGB-encoded
    // World-space position: red, green and blue rise and fall every two metres of x, y and z. The
    // pattern stays fixed to the surfaces when the camera moves, unless depth or matrices are
    // wrong.
    CND_SURFACE_POSITION = 5,
    // Grey that darkens towards grazing view angles, with faults marked in colour. Magenta: a NaN
    // or infinite normal, roughness, albedo, F0 or F90. Blue: a position that is not finite or not
    // in front of the eye. Yellow: a stored normal whose length differs from 1 by more than 2%.
    // Red: a normal that faces away from the eye by more than 10 degrees. Cyan: roughness outside
    // 0..1. Orange: albedo, F0 or F90 outside 0..1. If a pixel has several faults, the first in
    // this order is shown. Yellow and cyan occur with CND_GBUFFER_HOST only.
    CND_SURFACE_FAULTS = 6,
    CND_SURFACE_QUANTITY_MAX_ENUM = 0x7FFFFFFF
} CndSurfaceQuantity;

// The target of cndRecordSurfaceOverlay. On entry: `image` is in VK_IMAGE_LAYOUT_GENERAL, visible
// to COMPUTE_SHADER / SHADER_STORAGE_WRITE. On exit: the same layout, written by COMPUTE_SHADER /
// SHADER_STORAGE_WRITE.
typedef struct CndSurfaceOverlay {
    uint32_t structSize;
    CndSurfaceQuantity quantity;
    // Storage image of CndLightingDesc::overlayFormat, to be displayed like
    // CndExposureFrame::display.
    VkImageView image;
} CndSurfaceOverlay;

// Statistics of one frame of a view.
typedef struct CndLightingStats {
    uint32_t structSize;
    // Lights of the set, in all layers; CndDeviceLights counts as its maxCount.
    uint32_t lightCount;
    uint32_t deviceLights; // valid lights read from CndDeviceLights
    // Lights in CndDeviceLights that emit nothing, because a member is outside its range or the
    // light is beyond maxCount.
    uint32_t rejectedLights;
    // lightCount by light type. Types without lights have no passes.
    uint32_t lightTypeCounts[CND_LIGHT_TYPE_COUNT];
    uint32_t tileCount; // 8x8 pixel tiles that contain a surface; 0 if no light is in view
    // How many of tileCount are deep, and are therefore split into slices of depth with a list
    // each.
    uint32_t splitTileCount;
    // How many of tileCount have no surface with a specular lobe
    // (CndLightingDesc::diffuseOnlyTiles).
    uint32_t diffuseTileCount;
    uint32_t listEntries;   // sum of the lengths of all lists
    uint32_t maxListLength; // length of the longest list of one cluster and light type
    // Clusters without a list, summed over light types. Their list exceeds the list budget or the
    // shadow budget, or has more lights than a loop of the device may take, as a message says.
    // Their pixels walk the light tree instead.
    uint32_t unlistedClusters;
    // How many more bytes of CndLightingViewDesc::listBudget would do; 0: nothing is missing. First
    // come the lists of blocks of 4x4 tiles, from which those of clusters are made: while these are
    // missing, only they count, so a view with the larger budget may miss some bytes again. Then
    // unlistedClusters may be 0, but lists are made more slowly, and with shadows there are fewer
    // wonProofs. Last comes the room for the sums of long lists, each of which is otherwise walked
    // by one group.
    uint64_t missingListBytes;
    // With CND_INFLUENCE_BY_ERROR: illuminance (lx) at which lights are cut; 0: no light is cut.
    float cutBelow;
    // With countPairs, the next four members count (pixel, light) pairs; otherwise they are 0. A
    // pixel whose cluster has no list for a light type (unlistedClusters) is not counted for that
    // type. listedPairs counts the lights that the pixels test: those on the pixel's lists, and all
    // distant lights. Distant lights of other layers count here, but not in the members below.
    uint64_t listedPairs;
    // Iterations of the loops that evaluate lights, summed over shader invocations, including
    // iterations in which an invocation only waits for others of its subgroup.
    uint64_t evaluatedPairs;
    uint64_t insidePairs;       // listed pairs with distance < influence radius
    uint64_t contributingPairs; // inside pairs whose emitter is not wholly below the horizon
    // With countPairs and CndLightingDesc::shadows: pairs whose visibility was asked for, in this
    // frame or in the one whose answers it reuses, those of which the pixel sees a part of the
    // light, and those of which it sees nothing. The same pixels count as above. Those of
    // litEntries and hiddenEntries are not asked for.
    uint64_t askedPairs, partlyLitPairs, darkPairs;
    // How this frame finds the shadows of the lights in lists; 0 if it reuses them
    // (surfacesUnchanged). litEntries: no occluder is between the list's cluster and the light.
    // hiddenEntries: one occluder is proven to hide the light from the whole cluster.
    // testedEntries: pixels test the few triangles that may be between. walkedEntries: these are
    // too many, or the light is too near, and pixels walk through the trees of the occluders.
    uint32_t litEntries, hiddenEntries, testedEntries, walkedEntries;
    // testedEntries and walkedEntries take a slot each, 256 bytes of
    // CndLightingViewDesc::shadowBudget. shadowSlots: how many were taken. missingShadowSlots:
    // about how many more would do; clusters without room count in unlistedClusters. It is an
    // estimate, because lights of lists without room are not searched. A budget for the sum of both
    // is about enough, unless missingListBytes is not 0. Brute force and distant lights do not
    // count.
    uint32_t shadowSlots, missingShadowSlots;
    // On devices that limit loops: pairs whose search for occluders was cut off in this frame. They
    // have fewer shadows than they should.
    uint32_t unfinishedPairs;
    // Pairs of a part of 32x32 pixels and a light, for which a proof was tried that one occluder
    // hides the light from all of them, and those proven. Proven lights are in no list or count.
    uint32_t triedProofs, wonProofs;
    uint32_t kernelTimeCount; // 0 without timestamps
    CndKernelTime kernelTimes[CND_MAX_KERNEL_TIMES];
    uint32_t passCount; // all passes of the module, in order
    CndPassPlan passes[CND_MAX_PASSES];
} CndLightingStats;

// Writes exactly how much memory cndCreateLighting and cndCreateLightingView for `viewCount` views
// will take, without allocating any. Light sets within lightCapacity and lightTypes take no more,
// except for staging buffers. Fails with the same errors as creation would.
CND_API CndResult cndPlanLighting(const CndDeviceDesc* device, const CndLightingDesc* desc,
                                  uint32_t viewCount, const CndLightingViewDesc* views,
                                  CndMemoryUsage* usage, CndError* error);
// Creates the module: pipelines and an empty light set.
CND_API CndResult cndCreateLighting(const CndDeviceDesc* device, const CndLightingDesc* desc,
                                    CndLighting* lighting, CndError* error);
// The GPU must have finished all work recorded with the object or its views. Destroy the views
// first. NULL is ignored.
CND_API void cndDestroyLighting(CndLighting lighting);
// Writes how much memory the module and its views hold now. This includes memory that only frames
// in flight may still use. A later call that sets or edits lights or occluders frees it.
CND_API CndResult cndGetLightingMemory(CndLighting lighting, CndMemoryUsage* usage,
                                       CndError* error);

// Pipelines that are added to those of a module.
typedef struct CndLightingPipelines {
    uint32_t structSize;
    // Mask of 1 << CndLightType: types that light sets may then contain without creating more
    // pipelines.
    uint32_t lightTypes;
    // Mask of 1 << CndSpecularMethod: methods that frames may then ask for, with `shading`, a mask
    // of CndShadingBits (0: all of it). Without methods, `shading` has no effect.
    uint32_t specularMethods, shading;
} CndLightingPipelines;

// Creates those of `pipelines` that the module does not have yet, which may take seconds. For each
// method, it creates the pipelines of all light types that are in CndLightingDesc::lightTypes, were
// added, or have been in a light set. For each light type, it creates those of all methods and
// shading that frames may ask for. When the call returns, frames and light sets may use the
// pipelines. Until then, frames continue as before.
//
// This is the only call on a module that may run while other calls on the same module run: those
// that record, read statistics, set or edit lights or occluders, create or destroy views, and this
// call itself. It must not run while cndCreateLighting or cndDestroyLighting does. Both threads
// then use CndDeviceDesc::pipelineCache and allocationCallbacks. So the cache must not have been
// created with VK_PIPELINE_CACHE_CREATE_EXTERNALLY_SYNCHRONIZED_BIT, and the callbacks must be safe
// to call from both.
//
// On error, frames and light sets may use what they could use before. Later calls do not create
// what this call asked for. Pipelines that were created are kept for the next call.
CND_API CndResult cndAddLightingPipelines(CndLighting lighting,
                                          const CndLightingPipelines* pipelines, CndError* error);

// Replaces the light set. The new set takes effect at the next recording. The id of each light is
// its index; ids of the previous set must no longer be used. On error the previous set stays.
// Allocates memory if there are more lights than the capacity, and creates pipelines and list
// buffers if a light type is new. Lights are uploaded through a staging buffer of 68 bytes per
// light of the capacity. Another one is allocated whenever frames in flight still read all existing
// ones.
CND_API CndResult cndSetLights(CndLighting lighting, const CndLightSet* set, CndError* error);

// The three functions below edit the light set. They are for sets in which few lights change. Only
// the edited lights are validated, packed and uploaded (68 bytes each). Edits take effect at the
// next recording, which sorts the set again on the device. CndDeviceLights are not read again. On
// error nothing has changed. Memory is allocated if the set grows beyond the capacity, and
// pipelines are created if a light type is new. The same sequence of calls gives the same image,
// bit for bit. Setting the same lights in one call gives the same image except for rounding,
// because lights of equal place and size are summed in an order that depends on the edits.

// Adds `count` lights to the set, around its origin, and writes their ids to `ids` (`count`
// elements). It works without a previous cndSetLights; the origin is then (0, 0, 0).
CND_API CndResult cndAddLights(CndLighting lighting, uint32_t count, const CndLight* lights,
                               CndLightId* ids, CndError* error);
// Replaces the lights with these ids by `lights`, which may be of another type. No id may occur
// twice.
CND_API CndResult cndUpdateLights(CndLighting lighting, uint32_t count, const CndLightId* ids,
                                  const CndLight* lights, CndError* error);
// Removes the lights with these ids. No id may occur twice.
CND_API CndResult cndRemoveLights(CndLighting lighting, uint32_t count, const CndLightId* ids,
                                  CndError* error);

// Creates a view. The CndLighting must outlive it.
CND_API CndResult cndCreateLightingView(CndLighting lighting, const CndLightingViewDesc* desc,
                                        CndLightingView* view, CndError* error);
// The GPU must have finished all work recorded with the view. NULL is ignored.
CND_API void cndDestroyLightingView(CndLightingView view);

// Records culling and shading of one frame. Changes the compute pipeline, compute descriptor sets 0
// and 1 and the push constants; must be recorded outside a render pass. The first recording after a
// change uploads the changed lights and occluders, whichever view it is of. So each recording of
// each view of one CndLighting must be submitted exactly once, in the order in which they were
// recorded, to one queue.
CND_API CndResult cndRecordLighting(CndLightingView view, VkCommandBuffer cmd,
                                    const CndLightingFrame* frame, CndError* error);

// Records a picture of what the module reads from the G-buffer, to find mistakes in an integration.
// It uses these members of `frame`: frameSlot, x, y, size, camera, clearDepth, hostSet and the
// G-buffer images, which must be as on entry to cndRecordLighting. Record at most one overlay per
// frame: each frame slot has one descriptor set for it. Changes the compute pipeline, compute
// descriptor sets 0 and 1 and the push constants; must be recorded outside a render pass. It
// records no memory barrier. It works with or without cndRecordLighting in the same frame.
CND_API CndResult cndRecordSurfaceOverlay(CndLightingView view, VkCommandBuffer cmd,
                                          const CndLightingFrame* frame,
                                          const CndSurfaceOverlay* overlay, CndError* error);

// The functions below give the host's own shaders access to the lights, for transparent surfaces,
// particles and volumes. They need CndLightingDesc::forwardStages. The shaders include
// lib/forward.glsl of the installed shaders. It shades with CND_SPECULAR_CONIC and the lobes of the
// frame, at any position that the frame's camera can show.

// Writes the layout of the forward set, for pipeline layouts: storage buffers and uniform texel
// buffers. The layout lives as long as the module. Fails with CND_ERROR_INVALID_ARGUMENT if
// forwardStages is 0.
CND_API CndResult cndGetForwardSetLayout(CndLighting lighting, VkDescriptorSetLayout* layout,
                                         CndError* error);
// Writes the descriptor set that holds the lights of the last frame recorded in frameSlot. It may
// be bound in commands that are submitted after that recording, to the same queue, until any frame
// of the view is recorded again, because there is only one copy of the lights. The handle of a slot
// never changes and lives as long as the view. The host needs no barrier. cndRecordLighting waits
// for shaders of forwardStages before it writes, and makes what it wrote visible to them.
CND_API CndResult cndGetForwardSet(CndLightingView view, uint32_t frameSlot, VkDescriptorSet* set,
                                   CndError* error);

// Writes statistics of the last frame recorded in frameSlot. Returns CND_NOT_READY until the GPU
// has finished that frame. If the device is lost before that, it returns CND_NOT_READY for ever.
// The host learns of a lost device from the results of its own submissions and waits. Returns
// CND_ERROR_INVALID_ARGUMENT before the first frame of the slot.
CND_API CndResult cndGetLightingStats(CndLightingView view, uint32_t frameSlot,
                                      CndLightingStats* stats);

#ifdef __cplusplus
}
#endif
#endif
