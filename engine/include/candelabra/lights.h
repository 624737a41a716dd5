// SPDX-License-Identifier: Apache-2.0
// Lights, light sets, and the conversions of their photometric units.
#ifndef CANDELABRA_LIGHTS_H
#define CANDELABRA_LIGHTS_H

#include "candelabra/core.h"

#ifdef __cplusplus
extern "C" {
#endif

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

// Layers of lights and views: bits of a mask. 0 stands for all of them, so that a struct of zeros
// is in every layer; what is in none has no use: remove the light.
#define CND_LAYER_COUNT 16

// One light. Fields that a type does not use are ignored.
// Window: a light is multiplied by (1 - (d/r)^4)^2 for d < r and is absent for d >= r, with d the
// distance to its centre and r = influenceRadius (Lagarde and de Rousiers 2014, eq. 26, squared
// window); with r = INFINITY it is neither windowed nor cut. Directional and distant lights have
// no window.
typedef struct CndLight {
    uint32_t type;      // CndLightType
    float position[3];  // centre, metres, within 1e15 of CndLightSet::origin; all but directional
                        //   and distant
    float radius;       // 1e-15..1e15; sphere, tube, disc: metres; distant sphere: radius over
                        //   distance, the sine of its angular radius, <= 1 (the Sun: 0.00465)
    float direction[3]; // unit (1e-3). Spot, directional, distant: the way the light travels;
                        //   disc: its normal, the way it faces
    float emission[3];  // >= 0, finite; unit by type, per Rec.709 channel
    // Metres, > 0, or INFINITY; greater than the reach of the emitter from its centre (sphere and
    // disc: radius; tube: |axisU| + radius; rectangle: half its diagonal). All but directional and
    // distant.
    float influenceRadius;
    float innerConeAngle; // radians, 0 <= inner < outer; spot: full intensity inside (half angle)
    float outerConeAngle; // radians, inner < outer <= pi/2; spot: no light outside (half angle);
                          //   cos inner - cos outer >= 1e-6
    // Metres, length at least 1e-15, components within 1e15. Tube: from the centre to one end of
    // its segment. Rectangle: from the centre to the middle of one edge, and of the next
    // (perpendicular within 1e-3); it faces axisU x axisV.
    float axisU[3];
    float axisV[3];
    VkBool32 twoSided; // rectangle, disc: emits from its back as well
    // Mask of 1 << layer, below CND_LAYER_COUNT; 0: all. A light is there for the frames that have
    // a layer in common with it (CndLightingFrame::layers).
    uint32_t layers;
} CndLight;

// Names a light for as long as it is in the set. Lights of cndSetLights have their index in it,
// those of cndAddLights what that says: at least 2^32, and never the id of a light before. The id
// of a light that is gone is refused.
typedef uint64_t CndLightId;

// A light in a buffer of the device, written by a particle simulation for instance. 32 bytes, two
// vec4 in GLSL. Ranges are those of CndLight.
typedef struct CndDeviceLight {
    float position[3];     // metres, relative to CndLightSet::origin
    float radius;          // metres; ignored for point lights
    float emission[3];     // as CndLight, by type
    float influenceRadius; // metres
} CndDeviceLight;

// Lights of one type that never visit the host. Buffers are borrowed: they must stay as they are
// until the GPU has finished the first recording after cndSetLights, which reads them; call it
// again, with the same values, for what was written since (it allocates nothing then). On entry
// their contents are made visible to COMPUTE_SHADER / SHADER_STORAGE_READ.
// The host cannot check them: what is outside its range gives no light and is counted in
// CndLightingStats::rejectedLights, like what is beyond maxCount.
typedef struct CndDeviceLights {
    uint32_t type;            // CND_LIGHT_POINT or CND_LIGHT_SPHERE
    uint32_t maxCount;        // CndDeviceLight in `buffer`, > 0; time and memory are paid for all
    VkBuffer buffer;          // usage STORAGE_BUFFER
    VkDeviceSize offset;      // bytes, a multiple of minStorageBufferOffsetAlignment
    VkBuffer countBuffer;     // holds how many there are, one uint32_t; VK_NULL_HANDLE: maxCount
    VkDeviceSize countOffset; // bytes, a multiple of minStorageBufferOffsetAlignment
    // Where most of them are and how far most of them reach, metres: for speed alone.
    float boundsMin[3], boundsMax[3];
    float influenceRadius;
    uint32_t layers; // of all of them, as CndLight::layers
} CndDeviceLights;

// A set of lights around an origin. The engine subtracts the camera from the origin in double, so
// precision depends on the distance from a light to its origin only.
typedef struct CndLightSet {
    uint32_t structSize;
    uint32_t count;
    const CndLight* lights;              // count elements, read before the call returns
    double origin[3];                    // world space, metres
    const CndDeviceLights* deviceLights; // may be NULL: none
} CndLightSet;

// Largest CndLightSet::count, with CndDeviceLights::maxCount, for a device with these limits;
// `limits` may not be NULL.
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
// The power functions compute in double, round once and check nothing: lengths are > 0.

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
// of the light set like CndLight::position. Computed in double; influenceRadius and layers are
// kept. On error nothing is written.

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

#ifdef __cplusplus
}
#endif
#endif
