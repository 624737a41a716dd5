// SPDX-License-Identifier: Apache-2.0
// What crosses to surface_overlay, the kernel that shows what is read of a G-buffer.
#ifndef CND_SHARED_SURFACE_OVERLAY_H
#define CND_SHARED_SURFACE_OVERLAY_H

#include "shared/lighting.h"

GPU_BEGIN

// CndSurfaceQuantity.
const uint SURFACE_ALL = 0u;
const uint SURFACE_NORMAL = 1u;
const uint SURFACE_ROUGHNESS = 2u;
const uint SURFACE_ALBEDO = 3u;
const uint SURFACE_F0 = 4u;
const uint SURFACE_POSITION = 5u;
const uint SURFACE_FAULTS = 6u;
const uint SURFACE_COLUMNS = 3u; // of SURFACE_ALL
const uint SURFACE_ROWS = 2u;

// One lane per pixel. Bindings of the G-buffer are those of shade_tiles.
const uint SURFACE_OVERLAY_GROUP = 8u; // x and y
const uint SURFACE_OVERLAY_IMAGE = 7u;
struct SurfaceOverlayParams {
    Projection projection;
    uvec2 size;
    vec2 invImageSize; // 1 / size
    float clearDepth;
    uint quantity; // SURFACE_*
    vec3 eyeWorld; // m, of view space's origin, modulo SURFACE_PERIOD
    mat3 worldFromView;
};
GPU_SIZE(SurfaceOverlayParams, 128)
const float SURFACE_PERIOD = 2.0f; // m, of the colours of SURFACE_POSITION

// Faults. A normal of 8-bit channels is off by sqrt(3) / 255 at most, one blended on the way here
// by much more.
const float SURFACE_LENGTH_TOLERANCE = 0.02f;
const float SURFACE_FACING_TOLERANCE =
    0.17365f; // sine of 10 degrees: interpolated normals lean over
// Half floats and filtered ends of a range.
const float SURFACE_RANGE_TOLERANCE = 1e-3f;

GPU_END

#endif
