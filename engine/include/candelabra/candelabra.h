// SPDX-License-Identifier: Apache-2.0
// Candelabra: C ABI of the lighting, environment and exposure modules.
//
// Conventions
//   Units: metres, seconds, radians, photometric light units (lm, cd, lx, cd/m^2). Colours are
//   linear Rec.709. Matrices are column-major (element [column*4 + row]), vectors are columns.
//   Ownership: a module borrows every Vulkan handle it is given, owns only what it created, never
//   creates a device or a queue, never submits and never waits. Recording allocates nothing.
//   Threads: different objects may be used from different threads; calls on one object, or on a
//   view and the CndLighting it came from, must not overlap.
//   Errors: every function that can fail returns a CndResult and, when `error` is not NULL, one
//   sentence naming the offending thing. Nothing is thrown.
//   Versioning: every descriptor starts with structSize = sizeof(the struct).
#ifndef CANDELABRA_CANDELABRA_H
#define CANDELABRA_CANDELABRA_H

#include <stddef.h>
#include <stdint.h>

#include <vulkan/vulkan_core.h>

#define CND_VERSION_MAJOR 0
#define CND_VERSION_MINOR 1
#define CND_VERSION_PATCH 0
#define CND_MAKE_VERSION(major, minor, patch) (((major) << 22) | ((minor) << 12) | (patch))
#define CND_VERSION CND_MAKE_VERSION(CND_VERSION_MAJOR, CND_VERSION_MINOR, CND_VERSION_PATCH)

#if defined(__GNUC__)
#define CND_API __attribute__((visibility("default")))
#else
#define CND_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

typedef enum CndResult {
    CND_SUCCESS = 0,
    CND_NOT_READY = 1,               // statistics: the GPU has not finished that frame yet
    CND_ERROR_INVALID_ARGUMENT = -1, // a value outside its documented range
    CND_ERROR_UNSUPPORTED = -2,      // the device lacks a feature, format or limit
    CND_ERROR_OUT_OF_MEMORY = -3,
    CND_ERROR_DEVICE = -4, // a Vulkan call failed; vkResult tells which way
    CND_RESULT_MAX_ENUM = 0x7FFFFFFF
} CndResult;

typedef struct CndError {
    CndResult code;
    VkResult vkResult; // VK_SUCCESS when no Vulkan call was at fault
    char message[512]; // one sentence, zero terminated
} CndError;

// Version of the library that was linked, as CND_MAKE_VERSION.
CND_API uint32_t cndGetVersion(void);

// --------------------------------------------------------------------------------------------
// Device contract

// Borrowed handles; they must outlive every object created from them.
typedef struct CndDeviceDesc {
    uint32_t structSize;
    VkInstance instance;
    VkPhysicalDevice physicalDevice;
    VkDevice device;
    PFN_vkGetInstanceProcAddr getInstanceProcAddr;
    VkPipelineCache pipelineCache;                    // may be VK_NULL_HANDLE
    const VkAllocationCallbacks* allocationCallbacks; // may be NULL
    VkBool32
        debugUtilsEnabled; // VK_EXT_debug_utils is enabled on the instance: name and label objects
} CndDeviceDesc;

// Writes into `missing` (comma separated, zero terminated, truncated at missingSize) what the
// device lacks; CND_SUCCESS when it lacks nothing, CND_ERROR_UNSUPPORTED otherwise.
CND_API CndResult cndCheckDevice(VkInstance instance, VkPhysicalDevice physicalDevice,
                                 PFN_vkGetInstanceProcAddr getInstanceProcAddr, char* missing,
                                 size_t missingSize);

// Sets to VK_TRUE, in feature structs the host chains into VkDeviceCreateInfo, every feature that
// the modules need. Other members are left alone. Pointers may not be NULL.
CND_API void cndRequireFeatures(VkPhysicalDeviceFeatures* core10,
                                VkPhysicalDeviceVulkan12Features* core12,
                                VkPhysicalDeviceVulkan13Features* core13);

// --------------------------------------------------------------------------------------------
// Lights

typedef enum CndLightType {
    CND_LIGHT_POINT = 0,  // emission: luminous intensity, cd
    CND_LIGHT_SPHERE = 1, // emission: luminance, cd/m^2, constant over the sphere and directions
    CND_LIGHT_SPOT = 2,   // emission: luminous intensity on the axis, cd
    CND_LIGHT_DIRECTIONAL = 3,    // emission: illuminance on a surface that faces it, lx
    CND_LIGHT_DISTANT_SPHERE = 4, // the sun: a sphere infinitely far away; luminance, cd/m^2
    CND_LIGHT_TUBE = 5,      // capsule: all points within radius of a segment; luminance, cd/m^2
    CND_LIGHT_RECTANGLE = 6, // luminance, cd/m^2
    CND_LIGHT_DISC = 7,      // luminance, cd/m^2
    CND_LIGHT_TYPE_COUNT = 8,
    CND_LIGHT_TYPE_MAX_ENUM = 0x7FFFFFFF
} CndLightType;

// One light. Fields that a type does not use are ignored.
// Window: a light is multiplied by (1 - (d/r)^4)^2 for d < r and is absent for d >= r, with d the
// distance to its centre and r = influenceRadius (Lagarde and de Rousiers 2014, eq. 26, squared
// window); with r = INFINITY it is neither windowed nor cut. Directional and distant lights have
// no window.
typedef struct CndLight {
    uint32_t type;     // CndLightType
    float position[3]; // centre, metres, within 1e15 of CndLightSet::origin; all but directional
                       //   and distant
    float radius;      // > 0; sphere, tube, disc: metres; distant sphere: radius over distance, the
                       //   sine of its angular radius, <= 1 (the Sun: 0.00465)
    float direction[3]; // unit (1e-3). Spot, directional, distant: the way the light travels;
                        //   disc: its normal, the way it faces
    float emission[3];  // >= 0, finite; unit by type, per Rec.709 channel
    // Metres, > 0, or INFINITY; greater than the reach of the emitter from its centre (sphere and
    // disc: radius; tube: |axisU| + radius; rectangle: half its diagonal). All but directional and
    // distant.
    float influenceRadius;
    float innerConeAngle; // radians, 0 <= inner < outer; spot: full intensity inside (half angle)
    float outerConeAngle; // radians, inner < outer <= pi/2; spot: no light outside (half angle)
    // Metres, not zero. Tube: from the centre to one end of its segment. Rectangle: from the centre
    // to the middle of one edge, and of the next (perpendicular within 1e-3); it faces axisU x
    // axisV.
    float axisU[3];
    float axisV[3];
    VkBool32 twoSided; // rectangle, disc: emits from its back as well
} CndLight;

// A set of lights around an origin. The engine subtracts the camera from the origin in double, so
// precision depends on the distance from a light to its origin only.
typedef struct CndLightSet {
    uint32_t structSize;
    uint32_t count;
    const CndLight* lights; // count elements, read before the call returns
    double origin[3];       // world space, metres
} CndLightSet;

// Largest CndLightSet::count for a device with these limits; `limits` may not be NULL.
CND_API uint32_t cndMaxLightCount(const VkPhysicalDeviceLimits* limits);

// Conversions of photometric units
//
// Area lights are Lambertian emitters: from every point of their surface comes the same luminance L
// in every direction, so a convex one of area A emits Phi = pi A L, and the irradiance of a surface
// under it is E = L times the projected solid angle (a sphere wholly above the horizon: E = pi L
// s^2 cos, with s = R / d). E, Phi, I and L below are per Rec.709 channel.
//
// c_light: in rendering the "colour" of a light often is what a white Lambertian surface that faces
// it shows, E = pi c_light. In that convention directional lights have emission = pi c_light, point
// lights at distance d emission = pi c_light d^2, spheres and distant spheres emission = c_light /
// s^2.
//
// The power functions divide and multiply in single precision and check nothing: lengths are > 0.

// Luminance (cd/m^2) of a sphere of `radius` metres that emits `luminousPower` lumens evenly:
// Phi = 4 pi^2 R^2 L. Keeping the power while changing the radius keeps the far field.
CND_API float cndSphereLuminanceFromPower(float luminousPower, float radius);
// Luminance (cd/m^2) of a sphere of `radius` metres with the far field of a point light of
// `intensity` candela: I = pi R^2 L.
CND_API float cndSphereLuminanceFromIntensity(float intensity, float radius);
// Luminance (cd/m^2) of a tube that emits `luminousPower` lumens. `length`: metres between the end
// points of its segment, 2 |axisU|, may be 0; A = 2 pi R (length + 2 R).
CND_API float cndTubeLuminanceFromPower(float luminousPower, float length, float radius);
// Luminance (cd/m^2) of a rectangle with sides `width` = 2 |axisU| and `height` = 2 |axisV|,
// metres; A = width height, twice that when it is two-sided.
CND_API float cndRectangleLuminanceFromPower(float luminousPower, float width, float height,
                                             VkBool32 twoSided);
// Luminance (cd/m^2) of a disc; A = pi R^2, twice that when it is two-sided.
CND_API float cndDiscLuminanceFromPower(float luminousPower, float radius, VkBool32 twoSided);
// Luminous flux (lm) of `watts` of radiation at 555 nm: 683 lm/W (SI definition of the candela).
CND_API float cndLuminousPowerFromWatts(float watts);
// Luminous power (lm) that `light` emits, without its window: spheres, tubes, rectangles and discs
// as above, points 4 pi I, spots 2 pi I (1 - cos inner + (cos inner - cos outer) / 3). Directional
// and distant lights have none: CND_ERROR_INVALID_ARGUMENT.
CND_API CndResult cndLuminousPowerOfLight(const CndLight* light, float luminousPower[3],
                                          CndError* error);

// One kind of light as another with the same irradiance at a receiver, however it is turned while
// the whole emitter is above its horizon. `at` is the receiver's position, relative to the origin
// of the light set like CndLight::position. Computed in double; influenceRadius is kept. On error
// nothing is written.

// The Sun's sine of the angular radius, 695,700 km / 149.6e6 km (IAU 2015 B3, 2012 B2).
#define CND_SUN_SINE 0.00465f

// A point light as a sphere with the same position and far field, L = I / (pi R^2). `radius`:
// metres, smaller than the distance to `at`; 0 chooses a thousandth of that distance: small enough
// to look like a point, while the luminance is a million times c_light and no more, R is 10,000
// steps of single precision at that distance, and the form factor is in the range it is measured in
// (s >= 1e-5).
CND_API CndResult cndSphereFromPoint(const CndLight* point, float radius, const float at[3],
                                     CndLight* sphere, CndError* error);
// The limit of a sphere as its radius shrinks: I = pi R^2 L.
CND_API CndResult cndPointFromSphere(const CndLight* sphere, CndLight* point, CndError* error);
// A directional light as a distant sphere, L = E / (pi s^2). `sine`: of its angular radius, 0 < s
// <= 1; 0 chooses CND_SUN_SINE.
CND_API CndResult cndDistantSphereFromDirectional(const CndLight* directional, float sine,
                                                  CndLight* distantSphere, CndError* error);
// The limit of a distant sphere as its angular radius shrinks: E = pi s^2 L.
CND_API CndResult cndDirectionalFromDistantSphere(const CndLight* distantSphere,
                                                  CndLight* directional, CndError* error);
// A directional light as a sphere at a finite `distance` (metres) from `at`, of radius sine *
// distance. At a receiver x metres nearer, irradiance is (1 - x / distance)^-2 times that at `at`.
// A distance of 0 chooses the larger of 1e6 m (2% more at 10 km) and |at|: a step of single
// precision there is 1.2e-7 rad at most, 1/40,000 of the Sun's radius, and squared distances stay
// below 1e38. `sine` as above, but < 1.
CND_API CndResult cndSphereFromDirectional(const CndLight* directional, const float at[3],
                                           float distance, float sine, CndLight* sphere,
                                           CndError* error);
// A sphere as the directional light that `at` sees: from its centre, E = pi s^2 L W with the window
// W. `at` must be outside.
CND_API CndResult cndDirectionalFromSphere(const CndLight* sphere, const float at[3],
                                           CndLight* directional, CndError* error);

// --------------------------------------------------------------------------------------------
// Lighting

typedef struct CndLighting_T* CndLighting; // pipelines and one light set, shared by its views
typedef struct CndLightingView_T* CndLightingView; // buffers of one view

// How the specular lobe of sphere lights is evaluated. Errors: percent of the highest response over
// light directions, mean / 99th percentile, lights above the horizon; `candelabra bench accuracy`
// measures them. Tubes, rectangles and discs use a representative point with POINT, KARIS and KX
// and linearly transformed cosines with LTC, CONIC and CONIC_FULL.
typedef enum CndSpecularMethod {
    CND_SPECULAR_NONE = 0,  // diffuse only
    CND_SPECULAR_KARIS = 1, // normalised representative point (Karis 2013)
    CND_SPECULAR_POINT = 2, // all light from the centre
    CND_SPECULAR_KX = 3,    // representative point, unwidened lobe, exact normalisation of its peak
    CND_SPECULAR_LTC = 4,   // linearly transformed cosines (Heitz, Dupuy, Hill, Neubelt 2016)
    CND_SPECULAR_CONIC = 5, // slope-conic closed form; two shading nodes near the horizon. Default.
    CND_SPECULAR_CONIC_FULL = 6, // slope-conic, two shading nodes everywhere
    CND_SPECULAR_SAMPLED = 7,    // stochastic: CndLightingFrame::sampleCount samples per light
    CND_SPECULAR_METHOD_COUNT = 8,
    CND_SPECULAR_METHOD_MAX_ENUM = 0x7FFFFFFF
} CndSpecularMethod;

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

typedef enum CndCulling {
    CND_CULLING_CLUSTERED = 0, // exact lists per 8x8 tile
    CND_CULLING_BRUTE = 1, // every light at every pixel, no list, no bound; the check and baseline
    CND_CULLING_MAX_ENUM = 0x7FFFFFFF
} CndCulling;

// G-buffer layouts the module can read. See shaders/lib/gbuffer.glsl for packing functions and
// their declared error bounds.
typedef enum CndGBufferLayout {
    // normalRoughness R32G32_UINT: view-space octahedral normal 24+24 bits, perceptual roughness
    // unorm 16 (below 0.0447, that is alpha below 0.002, specular is evaluated at alpha 0.002);
    // albedo R16G16B16A16_SFLOAT: diffuse albedo (already scaled by 1 - metalness), a unused;
    // specular R16G16B16A16_SFLOAT: F0, a = Schlick F90 (with F0 = 0 as well: no specular lobe).
    CND_GBUFFER_FULL = 0,
    // normalRoughness R32_UINT: octahedral normal 12+12 bits, perceptual roughness unorm 8;
    // albedo R8G8B8A8_SRGB: base colour, a = metalness; F0 = mix(0.04, base colour, metalness).
    CND_GBUFFER_COMPACT = 1,
    CND_GBUFFER_LAYOUT_MAX_ENUM = 0x7FFFFFFF
} CndGBufferLayout;

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
} CndLightingDesc;

typedef struct CndLightingViewDesc {
    uint32_t structSize;
    uint32_t maxWidth, maxHeight; // pixels, 1..16384; frames may be smaller
    // Bytes for light lists, 0 = default (64 MiB). Tiles whose list does not fit are shaded by
    // walking all lights: slower, never wrong, and counted in CndLightingStats::unlistedTiles.
    VkDeviceSize listBudget;
} CndLightingViewDesc;

// A camera. The view transform is double; the projection is float.
typedef struct CndCamera {
    double viewFromWorld[16]; // rigid: rotation and translation only
    float clipFromView[16];   // perspective (finite or infinite, reversed or not) or orthographic
} CndCamera;

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
    VkImageView specular; // ignored by CND_GBUFFER_COMPACT (may be VK_NULL_HANDLE)
    VkImageView depth;    // depth aspect, D32_SFLOAT
    VkImageView radiance; // R32G32B32A32_SFLOAT, storage; outgoing luminance is ADDED (cd/m^2)
    CndSpecularMethod specularMethod; // one of CndLightingDesc::specularMethods
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
    VkRect2D bruteRect;  // CND_CULLING_BRUTE: pixels to shade; zero extent: all
    VkBool32 countPairs; // also count (pixel, light) pairs: one more kernel; clustered only
} CndLightingFrame;

typedef struct CndKernelTime {
    const char* name; // static storage
    double ms;
} CndKernelTime;

#define CND_MAX_KERNEL_TIMES 16

typedef struct CndLightingStats {
    uint32_t structSize;
    uint32_t lightCount;
    uint32_t tileCount;   // 8x8 pixel tiles that hold a surface; 0 without lights
    uint32_t listEntries; // entries of all tiles' lists
    uint32_t maxListLength;
    uint32_t unlistedTiles; // tiles over the list budget, shaded by walking all lights
    // (pixel, light) pairs, with countPairs, else 0:
    uint64_t listedPairs;     //   entries walked, summed over the surface pixels
    uint64_t insidePairs;     //   of those, distance < influence radius
    uint64_t evaluatedPairs;  //   of those, emitter not wholly below the horizon: BRDF evaluated
    uint32_t kernelTimeCount; // 0 without timestamps
    CndKernelTime kernelTimes[CND_MAX_KERNEL_TIMES];
} CndLightingStats;

CND_API CndResult cndCreateLighting(const CndDeviceDesc* device, const CndLightingDesc* desc,
                                    CndLighting* lighting, CndError* error);
// The GPU must have finished all work recorded with the object or its views; views go first.
CND_API void cndDestroyLighting(CndLighting lighting);

// Validates and packs the lights; takes effect at the next recording. On error the previous set
// stays. May allocate when the count grows, and makes pipelines when a light type is new.
CND_API CndResult cndSetLights(CndLighting lighting, const CndLightSet* set, CndError* error);

CND_API CndResult cndCreateLightingView(CndLighting lighting, const CndLightingViewDesc* desc,
                                        CndLightingView* view, CndError* error);
CND_API void cndDestroyLightingView(CndLightingView view);

// Records culling and shading. Changes compute pipeline, compute descriptor set 0 and push
// constants; must be outside a render pass. Lights travel in the first recording after
// cndSetLights, so recordings of all views of one CndLighting are submitted once each, in their
// order, to one queue.
CND_API CndResult cndRecordLighting(CndLightingView view, VkCommandBuffer cmd,
                                    const CndLightingFrame* frame, CndError* error);

// Statistics of the last frame recorded in frameSlot; CND_NOT_READY until the GPU has finished it.
CND_API CndResult cndGetLightingStats(CndLightingView view, uint32_t frameSlot,
                                      CndLightingStats* stats);

// --------------------------------------------------------------------------------------------
// Environment: an image of the far surroundings as a light

typedef struct CndEnvironment_T* CndEnvironment; // one image; any number of views

typedef struct CndEnvironmentDesc {
    uint32_t structSize;
    uint32_t framesInFlight; // 1..8, over all views together
    CndGBufferLayout gbufferLayout;
    // Texels of a cube face's side, a power of two 64..2048, 0 = default (256): what mirrors and
    // the background show. 256 * cubeSize^2 bytes (256: 17 MB).
    uint32_t cubeSize;
    VkBool32 timestamps; // time every kernel
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
    VkImageView specular; // ignored by CND_GBUFFER_COMPACT (may be VK_NULL_HANDLE)
    VkImageView depth;    // depth aspect, D32_SFLOAT
    VkImageView radiance; // R32G32B32A32_SFLOAT, storage; outgoing luminance is ADDED (cd/m^2)
    float worldFromEnvironment[9]; // rotation of the image's space, columns
    float scale;                   // >= 0, factor on the image's luminance
    VkBool32 background; // pixels without a surface show the environment, whatever they held
    CndLobeJoining lobes;
    // Light that bounces between microfacets is given back (Turquin 2019): without, a white metal
    // loses up to 69% of it.
    VkBool32 energyCompensation;
} CndEnvironmentFrame;

typedef struct CndEnvironmentStats {
    uint32_t structSize;
    uint32_t kernelTimeCount; // of the frame; 0 without timestamps
    CndKernelTime kernelTimes[CND_MAX_KERNEL_TIMES];
    uint32_t mapKernelTimeCount; // of the last cndRecordEnvironmentMap
    CndKernelTime mapKernelTimes[CND_MAX_KERNEL_TIMES];
} CndEnvironmentStats;

CND_API CndResult cndCreateEnvironment(const CndDeviceDesc* device, const CndEnvironmentDesc* desc,
                                       CndEnvironment* environment, CndError* error);
CND_API void cndDestroyEnvironment(CndEnvironment environment);
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

// --------------------------------------------------------------------------------------------
// Exposure: histogram eye adaptation and tone mapping

typedef struct CndExposure_T* CndExposure; // one per view: holds the adaptation history

typedef enum CndToneMap {
    CND_TONEMAP_NONE = 0, // exposed radiance clipped to [0,1]
    CND_TONEMAP_REINHARD = 1,
    CND_TONEMAP_ACES = 2,
    CND_TONEMAP_PBR_NEUTRAL = 3,
    CND_TONEMAP_AGX = 4,
    CND_TONEMAP_COUNT = 5,
    CND_TONEMAP_MAX_ENUM = 0x7FFFFFFF
} CndToneMap;

typedef enum CndMetering {
    CND_METERING_AVERAGE = 0,         // every pixel weighs 1
    CND_METERING_CENTRE_WEIGHTED = 1, // integer weights 1..15, falling with distance to the centre
    CND_METERING_MASK = 2,            // weights from cndSetExposureMask
    CND_METERING_MAX_ENUM = 0x7FFFFFFF
} CndMetering;

typedef struct CndExposureDesc {
    uint32_t structSize;
    uint32_t framesInFlight; // 1..8
    VkBool32 timestamps;
} CndExposureDesc;

// EV here is EV100 = log2(L * 100 / 12.5) for average luminance L in cd/m^2 (ISO 2720, K = 12.5).
// The average is the mean of log2 luminance between two percentiles of a histogram with 8 bins per
// octave from 2^-12 to 2^20 cd/m^2; darker pixels count in the first bin, brighter ones in the
// last. Pixels without any light (zero or negative luminance: an empty background) are counted in
// the first bin but left out of the mean, unless there is nothing else.
typedef struct CndExposureSettings {
    VkBool32 manual;          // use manualEv100, build no histogram
    float manualEv100;        // -64..64
    float compensation;       // EV, -32..32, added brightness: +1 doubles the image
    float minEv100, maxEv100; // -64..64, clamp of the adapted value, min <= max
    float lowPercentile;      // 0 <= low, low + 1e-6 <= high, high <= 1: share of the weighted
    float highPercentile;     //   histogram that is ignored below low and above high
    float speedUp, speedDown; // 1/s, > 0: rate towards brighter / darker scenes;
                              //   ev(t+dt) = target + (ev(t) - target) exp(-dt * speed)
    CndMetering metering;
    CndToneMap toneMap;
    // Noise before rounding to 8 bits that keeps the mean: triangular over two output steps, within
    // half a step of black and white uniform over one.
    VkBool32 dither;
} CndExposureSettings;

// Fills in the defaults: automatic, no compensation, EV100 -6..18, percentiles 0.10..0.90, speeds
// 3 and 1 per second, centre-weighted, PBR Neutral, dithered.
CND_API void cndDefaultExposureSettings(CndExposureSettings* settings);

// EV100 of a camera: log2(N^2 / t * 100 / S), aperture N in f-stops, shutter t in s, sensitivity S
// ISO.
CND_API float cndEv100FromCamera(float aperture, float shutterTime, float iso);
// Factor from luminance (cd/m^2) to exposed value: 1 / (1.2 * 2^EV100) (saturation-based speed,
// ISO 12232; Lagarde and de Rousiers 2014, eq. 85).
CND_API float cndExposureFromEv100(float ev100);

// On entry: radiance (R32G32B32A32_SFLOAT) in SHADER_READ_ONLY_OPTIMAL, visible to COMPUTE_SHADER
// SAMPLED_READ; display (R8G8B8A8_UNORM, storage) in GENERAL, or VK_NULL_HANDLE to adapt only.
// On exit: layouts unchanged, display written by COMPUTE_SHADER / SHADER_STORAGE_WRITE, not yet
// made visible. Radiance may hold anything: on the display NaN and negative channels are 0 and
// infinity is white; NaN is not metered.
typedef struct CndExposureFrame {
    uint32_t structSize;
    uint32_t frameSlot; // 0..framesInFlight-1; the GPU must have finished the slot's previous frame
    uint32_t width, height; // pixels, 1..16384; may change between frames, the history is kept
    VkImageView radiance;
    VkImageView display; // receives sRGB-encoded values
    float deltaTime;     // s since the previous frame, >= 0
    VkBool32 reset;      // jump to the converged value: first frame, camera cut, single image
    uint32_t ditherSeed; // same seed, same image
    CndExposureSettings settings;
} CndExposureFrame;

#define CND_HISTOGRAM_BINS 256

typedef struct CndExposureStats {
    uint32_t structSize;
    // Of the histogram (or manualEv100), clamped, before adaptation; where nothing was measured,
    // the history (with reset: EV 0).
    float targetEv100;
    float adaptedEv100;                     // in use, before compensation; the history
    float exposure;                         // factor applied to luminance, compensation included
    uint32_t invalidPixels;                 // NaN; left out of the histogram
    uint32_t histogram[CND_HISTOGRAM_BINS]; // weighted counts; zero in manual mode
    uint32_t kernelTimeCount;
    CndKernelTime kernelTimes[CND_MAX_KERNEL_TIMES];
} CndExposureStats;

CND_API CndResult cndCreateExposure(const CndDeviceDesc* device, const CndExposureDesc* desc,
                                    CndExposure* exposure, CndError* error);
CND_API void cndDestroyExposure(CndExposure exposure);
// Metering mask: width x height weights 0..15, row by row from the top, at most 64 x 64,
// stretched over the frame: pixel (x, y) of w x h takes row y * height / h, column x * width / w.
// The GPU must not be using the object.
CND_API CndResult cndSetExposureMask(CndExposure exposure, const uint8_t* weights, uint32_t width,
                                     uint32_t height, CndError* error);
// Records metering, adaptation and, with a display, tone mapping. The history lives on the GPU:
// submit frames in the order in which they are to adapt. The first one is always a reset. Changes
// compute pipeline, compute descriptor set 0 and push constants; must be outside a render pass.
CND_API CndResult cndRecordExposure(CndExposure exposure, VkCommandBuffer cmd,
                                    const CndExposureFrame* frame, CndError* error);
// Statistics of the last frame recorded in frameSlot; CND_NOT_READY until the GPU has finished it,
// which a host that waited for the slot never sees. CND_ERROR_INVALID_ARGUMENT before the first.
CND_API CndResult cndGetExposureStats(CndExposure exposure, uint32_t frameSlot,
                                      CndExposureStats* stats);

#ifdef __cplusplus
}
#endif
#endif
