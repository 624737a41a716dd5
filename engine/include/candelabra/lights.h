// SPDX-License-Identifier: Apache-2.0
// Lights, light sets, and conversions between photometric units.
#ifndef CANDELABRA_LIGHTS_H
#define CANDELABRA_LIGHTS_H

#include "candelabra/core.h"

#ifdef __cplusplus
extern "C" {
#endif

// The unit of CndLight::emission depends on the type. It is per Rec.709 channel.
typedef enum CndLightType {
    CND_LIGHT_POINT = 0,       // emission is luminous intensity, cd
    CND_LIGHT_SPHERE = 1,      // emission is luminance, cd/m^2, constant over the sphere and all
                               // directions
    CND_LIGHT_SPOT = 2,        // emission is luminous intensity on the axis, cd
    CND_LIGHT_DIRECTIONAL = 3, // emission is illuminance (lx) on a surface that faces the light
    // The sun: a sphere infinitely far away. Emission is luminance, cd/m^2.
    CND_LIGHT_DISTANT_SPHERE = 4,
    // A capsule: all points within `radius` of a line segment. Emission is luminance, cd/m^2.
    CND_LIGHT_TUBE = 5,
    CND_LIGHT_RECTANGLE = 6, // emission is luminance, cd/m^2
    CND_LIGHT_DISC = 7,      // emission is luminance, cd/m^2
    // A convex polygon with 3 to 8 corners. Emission is luminance, cd/m^2.
    CND_LIGHT_POLYGON = 8,
    CND_LIGHT_TYPE_COUNT = 9,
    CND_LIGHT_TYPE_MAX_ENUM = 0x7FFFFFFF
} CndLightType;

// Lights and frames have masks of layers, bits 0 to CND_LAYER_COUNT - 1. A light exists in the
// frames that share a layer with it. The mask 0 means all layers, so a zeroed struct is in every
// layer. To hide a light in all frames, remove it (cndRemoveLights).
#define CND_LAYER_COUNT 16

// Every occluder (occluders.h) is in one of so many occluder layers. Lights name the layers that do
// not shadow them.
#define CND_OCCLUDER_LAYER_COUNT 6

// The corners of a polygon light in the coordinates of its axes: corner i is at
//   position + corners[i][0] axisU + corners[i][1] axisV.
// cndPolygonFromCorners computes them from points in space.
#define CND_MAX_CORNERS 8
typedef struct CndPolygon {
    uint32_t cornerCount; // 3..CND_MAX_CORNERS
    // Each coordinate within -1..1, so that the polygon lies in the rectangle with the same axes.
    // The corners go counterclockwise (from axisU to axisV) around a convex outline: none is more
    // than 1e-6 outside the line through any edge. Neighbours are at least 1e-5 apart, and the area
    // is at least 1e-4, in these coordinates. Elements from cornerCount on are ignored.
    float corners[CND_MAX_CORNERS][2];
} CndPolygon;

// The smallest width of the edge of a spot's cone, outerConeAngle - innerConeAngle, in radians.
// Directions in single precision are accurate to 1e-7. So the intensity within an edge of this
// width is wrong by up to a few percent of the peak. If the width is at least 1e-4, it is wrong by
// less than 0.5%.
#define CND_MIN_CONE_EDGE 1e-5f

// One light. Fields that its type does not use are ignored.
//
// Window: a light is multiplied by (1 - (d/r)^4)^2 for d < r and is absent for d >= r, where d
// is the distance to its centre and r is influenceRadius (Lagarde and de Rousiers 2014, eq. 26,
// squared window). With r = INFINITY it is neither windowed nor cut. Directional and distant lights
// have no window.
typedef struct CndLight {
    uint32_t type; // CndLightType
    // Centre in metres, relative to CndLightSet::origin, each component within 1e15. Used by all
    // types but directional and distant sphere.
    float position[3];
    // 1e-15..1e15. Sphere, tube, disc: metres. Distant sphere: its radius divided by its distance,
    // which is the sine of its angular radius, at most 1 (the Sun: 0.00465).
    float radius;
    // Unit vector (length within 1e-3 of 1). Spot, directional, distant sphere: the direction in
    // which the light travels. Disc: its normal, the direction in which it emits.
    float direction[3];
    float emission[3]; // >= 0 and finite; unit by type, per Rec.709 channel
    // Metres, > 0, or INFINITY; greater than the distance from the centre to the farthest point of
    // the emitter (cndEmitterBoundingRadius; sphere and disc: radius; tube: |axisU| + radius;
    // rectangle: half its diagonal; polygon: distance of the farthest corner). Used by all types
    // but directional and distant sphere.
    float influenceRadius;
    // Spot: half angle of the cone with full intensity, radians, >= 0.
    float innerConeAngle;
    // Spot: half angle of the cone outside which there is no light, radians, at most pi/2 and at
    // least innerConeAngle + CND_MIN_CONE_EDGE. In between, at the angle theta from the axis, the
    // intensity is multiplied by ((cos theta - cos outer) / (cos inner - cos outer))^2.
    float outerConeAngle;
    // Metres, length at least 1e-15, components within 1e15. Tube: axisU points from the centre to
    // one end of its segment. Rectangle: axisU points from the centre to the middle of one edge,
    // axisV to the middle of an adjacent edge. They must be perpendicular: the cosine of their
    // angle is within 1e-3 of 0. The rectangle faces axisU x axisV. Polygon: the axes of such a
    // rectangle. The polygon lies in it and has the same front.
    float axisU[3];
    float axisV[3];
    VkBool32 twoSided; // rectangle, disc, polygon: VK_TRUE if the back emits as well
    // Mask of 1 << layer, layer < CND_LAYER_COUNT; 0: all layers. The light exists in frames that
    // share a layer with it (CndLightingFrame::layers).
    uint32_t layers;
    // Polygon: its corners, not NULL. They are read before a call that takes the light returns.
    const CndPolygon* polygon;
    // VK_TRUE: no occluder shadows this light (occluders.h).
    VkBool32 unshadowed;
    // Mask of 1 << occluder layer, layer < CND_OCCLUDER_LAYER_COUNT: occluders of these layers do
    // not shadow this light, for example the glass shade around a lamp. 0: all occluders do.
    uint32_t unshadowedBy;
} CndLight;

// The fields of CndLight that only some types use.
typedef enum CndLightFieldBits {
    CND_LIGHT_FIELD_POSITION_BIT = 1, // position and influenceRadius
    CND_LIGHT_FIELD_RADIUS_BIT = 2,
    CND_LIGHT_FIELD_DIRECTION_BIT = 4,
    CND_LIGHT_FIELD_CONE_BIT = 8, // innerConeAngle and outerConeAngle
    CND_LIGHT_FIELD_AXIS_U_BIT = 16,
    CND_LIGHT_FIELD_AXIS_V_BIT = 32,
    CND_LIGHT_FIELD_TWO_SIDED_BIT = 64,
    CND_LIGHT_FIELD_POLYGON_BIT = 128,
    CND_LIGHT_FIELD_BITS_MAX_ENUM = 0x7FFFFFFF
} CndLightFieldBits;

// Returns the fields that lights of a type use, a mask of CndLightFieldBits, or 0 if `lightType` is
// not a CndLightType.
CND_API uint32_t cndLightFields(uint32_t lightType);
// Returns VK_TRUE for the types whose lights are infinitely far away and have no position:
// directional and distant sphere.
CND_API VkBool32 cndIsDistant(uint32_t lightType);
// Returns VK_TRUE for the types whose lights have no size: point, spot and directional. The
// emission of all other types is luminance.
CND_API VkBool32 cndIsPunctual(uint32_t lightType);
// Returns the radius, in metres, of the sphere around the centre of `light` that holds its emitter.
// The axes are assumed to be perpendicular. The radius is 0 for punctual lights. For distant
// spheres it is the sine of the angular radius. `light` must not be NULL, nor the `polygon` of a
// polygon light. Only type and shape are read.
CND_API float cndEmitterBoundingRadius(const CndLight* light);

// Identifies a light for as long as it is in the set. The id of a light from cndSetLights is its
// index in the set. cndAddLights returns the ids of its lights; they are at least 2^32 and are
// never reused. The id of a light that has been removed is refused.
typedef uint64_t CndLightId;

// A light in a device buffer, written for example by a particle simulation. It has 32 bytes, or two
// vec4 in GLSL. Ranges are those of CndLight.
typedef struct CndDeviceLight {
    float position[3];     // metres, relative to CndLightSet::origin
    float radius;          // metres; ignored for point lights
    float emission[3];     // unit by type, as CndLight::emission
    float influenceRadius; // metres
} CndDeviceLight;

// Lights of one type that are written on the device and never visit the host.
//
// The buffers are borrowed. The first recording after cndSetLights reads them. They must not change
// until the GPU has finished that recording. To use lights that were written later, call
// cndSetLights again with the same values; that allocates at most a staging buffer (see
// cndSetLights). On entry to the recording the contents are visible to COMPUTE_SHADER /
// SHADER_STORAGE_READ.
//
// The host cannot check these lights. A light with a value outside its range emits nothing and is
// counted in CndLightingStats::rejectedLights, as are lights beyond maxCount.
typedef struct CndDeviceLights {
    uint32_t type; // CND_LIGHT_POINT or CND_LIGHT_SPHERE; a CndDeviceLight has no room for more
    // Capacity of `buffer` in lights, > 0. All of them cost time and memory, present or not.
    uint32_t maxCount;
    VkBuffer buffer;     // usage STORAGE_BUFFER
    VkDeviceSize offset; // bytes, a multiple of minStorageBufferOffsetAlignment
    // One uint32_t with the number of lights; VK_NULL_HANDLE: there are maxCount lights.
    VkBuffer countBuffer;
    VkDeviceSize countOffset; // bytes, a multiple of minStorageBufferOffsetAlignment
    // Where most of the lights are, relative to the origin, and how far most of them reach, in
    // metres. These members affect only speed.
    float boundsMin[3], boundsMax[3];
    float influenceRadius;
    // These three hold for every light of the buffer. They are as in CndLight.
    uint32_t layers;
    VkBool32 unshadowed;
    uint32_t unshadowedBy;
} CndDeviceLights;

// A set of lights, with positions relative to an origin. The engine subtracts the camera from the
// origin in double precision. So precision depends only on the distance of a light from the origin.
typedef struct CndLightSet {
    uint32_t structSize;
    uint32_t count;
    const CndLight* lights;              // count elements, read before the call returns
    double origin[3];                    // world space, metres, finite
    const CndDeviceLights* deviceLights; // may be NULL: there are none
} CndLightSet;

// Returns the largest number of lights in a set, CndLightSet::count plus CndDeviceLights::maxCount,
// for a device with these limits. `limits` must not be NULL.
CND_API uint32_t cndMaxLightCount(const VkPhysicalDeviceLimits* limits);

// Conversions of photometric units.
//
// Area lights are Lambertian emitters: every point of their surface has the same luminance L in all
// directions. So a convex emitter of area A emits the luminous power Phi = pi A L. A surface under
// it receives the illuminance E, which is L times the projected solid angle (for a sphere wholly
// above the horizon: E = pi L s^2 cos, with s = R / d). E, Phi, I and L below are per Rec.709
// channel.
//
// c_light: in rendering, the "colour" of a light often means the luminance of a white Lambertian
// surface that faces the light. That luminance is c_light = E / pi. In this convention directional
// lights have emission = pi c_light, point lights at distance d have emission = pi c_light d^2,
// and spheres and distant spheres, for which E = pi L s^2, have emission = c_light / s^2.
//
// The power functions compute in double precision and round once. The functions that return a float
// check nothing: radius, width and height must be > 0, and polygons must be valid.

// Returns the luminance (cd/m^2) of a sphere of `radius` metres that emits `luminousPower` lumens
// evenly: Phi = 4 pi^2 R^2 L. If the radius changes and the power stays the same, the far field
// stays the same.
CND_API float cndSphereLuminanceFromPower(float luminousPower, float radius);
// Returns the luminance (cd/m^2) of a sphere of `radius` metres that has the far field of a point
// light of `intensity` candela: I = pi R^2 L.
CND_API float cndSphereLuminanceFromIntensity(float intensity, float radius);
// Returns the luminance (cd/m^2) of a tube that emits `luminousPower` lumens. `length` is the
// distance between the end points of its segment in metres, 2 |axisU|, and may be 0;
// A = 2 pi R (length + 2 R).
CND_API float cndTubeLuminanceFromPower(float luminousPower, float length, float radius);
// Returns the luminance (cd/m^2) of a rectangle with sides `width` = 2 |axisU| and `height` = 2
// |axisV| in metres; A = width height, or twice that for a two-sided rectangle.
CND_API float cndRectangleLuminanceFromPower(float luminousPower, float width, float height,
                                             VkBool32 twoSided);
// Returns the luminance (cd/m^2) of a disc; A = pi R^2, or twice that for a two-sided disc.
CND_API float cndDiscLuminanceFromPower(float luminousPower, float radius, VkBool32 twoSided);
// Returns the luminance (cd/m^2) of a light with the shape of `polygon`, a valid polygon light of
// which only axes, corners and twoSided are read. A = |axisU| |axisV| times the area in the
// coordinates of its corners, or twice that for a two-sided polygon.
CND_API float cndPolygonLuminanceFromPower(float luminousPower, const CndLight* polygon);
// Returns the luminous power (lm) of `watts` of radiation at 555 nm: 683 lm/W (SI definition of the
// candela).
CND_API float cndLuminousPowerFromWatts(float watts);
// Writes the luminous power (lm) that `light` emits, ignoring its window. It is pi A L as above for
// area lights, 4 pi I for points, and 2 pi I (1 - cos inner + (cos inner - cos outer) / 3) for
// spots. Fails with CND_ERROR_INVALID_ARGUMENT for directional and distant lights, which have none.
CND_API CndResult cndLuminousPowerOfLight(const CndLight* light, float luminousPower[3],
                                          CndError* error);

// Sets type, position, axisU, axisV and polygon of `light` so that it is a polygon light with these
// corners, in metres, relative to the origin of the light set like CndLight::position. The front
// is the side from which they go counterclockwise. light->polygon becomes `polygon`, which is
// filled in and must live for as long as the light is passed to other calls. The other fields of
// `light` stay as they are. Fails with CND_ERROR_INVALID_ARGUMENT if `count` is not
// 3..CND_MAX_CORNERS; if a coordinate is not finite or beyond 1e15; if the corners are not in a
// plane, to 1e-4 of the polygon's size; if two neighbours coincide; if the outline is not convex;
// or if it encloses no area. On error nothing is written.
CND_API CndResult cndPolygonFromCorners(const float (*corners)[3], uint32_t count, CndLight* light,
                                        CndPolygon* polygon, CndError* error);

// Conversions of one type of light into another that has the same illuminance at a receiver,
// whatever the receiver's orientation, as long as the whole emitter is above the receiver's
// horizon. `at` is the receiver's position in metres, relative to the origin of the light set like
// CndLight::position. The conversions compute in double precision. influenceRadius and layers are
// kept where the new type has them. On error nothing is written.

// Sine of the Sun's angular radius, 695,700 km / 149.6e6 km (IAU 2015 B3, 2012 B2).
#define CND_SUN_SINE 0.00465f

// Converts a point light into a sphere with the same position and far field, L = I / (pi R^2).
// `radius` is in metres, smaller than the distance to `at` and smaller than influenceRadius. 0
// chooses a thousandth of that distance, or a quarter of influenceRadius if that is smaller. A
// thousandth is small enough to look like a point and large enough for single precision: the radius
// is at least 8,000 of its steps at that distance, the luminance is a million times c_light, and s
// = 1e-3 is well inside the range in which the form factor has been measured (s >= 1e-5).
CND_API CndResult cndSphereFromPoint(const CndLight* point, float radius, const float at[3],
                                     CndLight* sphere, CndError* error);
// Converts a sphere into the limit of that sphere as its radius shrinks, a point light: I = pi R^2
// L.
CND_API CndResult cndPointFromSphere(const CndLight* sphere, CndLight* point, CndError* error);
// Converts a directional light into a distant sphere, L = E / (pi s^2). `sine` is the sine s of its
// angular radius, 0 < s <= 1; 0 chooses CND_SUN_SINE.
CND_API CndResult cndDistantSphereFromDirectional(const CndLight* directional, float sine,
                                                  CndLight* distantSphere, CndError* error);
// Converts a distant sphere into the limit of that sphere as its angular radius shrinks, a
// directional light: E = pi s^2 L.
CND_API CndResult cndDirectionalFromDistantSphere(const CndLight* distantSphere,
                                                  CndLight* directional, CndError* error);
// Converts a directional light into a sphere at a finite `distance` (metres) from `at`, with radius
// sine * distance. A receiver x metres nearer to it gets (1 - x / distance)^-2 times the
// illuminance at `at`. A distance of 0 chooses the larger of 1e6 m (2% more at 10 km) and |at|: a
// step of single precision there is at most 1.2e-7 rad, 1/40,000 of the Sun's radius, and squared
// distances stay below 1e38. `sine` is as above, but < 1. influenceRadius becomes INFINITY.
CND_API CndResult cndSphereFromDirectional(const CndLight* directional, const float at[3],
                                           float distance, float sine, CndLight* sphere,
                                           CndError* error);
// Converts a sphere into the directional light that `at` sees: it comes from the centre of the
// sphere, and E = pi s^2 L W with the window W. `at` must be outside the sphere.
CND_API CndResult cndDirectionalFromSphere(const CndLight* sphere, const float at[3],
                                           CndLight* directional, CndError* error);

#ifdef __cplusplus
}
#endif
#endif
