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

// G-buffer layouts the modules can read. See shaders/lib/gbuffer.glsl for packing functions and
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
