// SPDX-License-Identifier: Apache-2.0
// The interface of surface_overlay, the kernel that shows which surfaces the engine reads from a
// G-buffer.
#ifndef CND_SHARED_SURFACE_OVERLAY_H
#define CND_SHARED_SURFACE_OVERLAY_H

#include "shared/host_gbuffer_data.h"
#include "shared/lighting_data.h"

GPU_BEGIN

// The values of CndSurfaceQuantity.
const uint SURFACE_ALL = 0u;
const uint SURFACE_NORMAL = 1u;
const uint SURFACE_ROUGHNESS = 2u;
const uint SURFACE_ALBEDO = 3u;
const uint SURFACE_F0 = 4u;
const uint SURFACE_POSITION = 5u;
const uint SURFACE_FAULTS = 6u;
const uint SURFACE_COLUMNS = 3u; // SURFACE_ALL shows a grid of pictures
const uint SURFACE_ROWS = 2u;

// One lane per pixel. The bindings of the G-buffer are the same as in shade_tiles.
const uint SURFACE_OVERLAY_GROUP = 8u; // x and y
const uint SURFACE_OVERLAY_IMAGE = 7u;
struct SurfaceOverlayParams {
    uint quantity; // SURFACE_*
    vec3 eyeWorld; // m; the origin of view space in world space, modulo SURFACE_PERIOD
    StoredDepth depth;
};
GPU_SIZE(SurfaceOverlayParams, 36)
const float SURFACE_PERIOD = 2.0f; // m; period of the colours of SURFACE_POSITION

// Tolerances of SURFACE_FAULTS.
// Error of a normal's length. 8-bit channels change it by at most sqrt(3) / 255, while blending
// between normals changes it by much more.
const float SURFACE_LENGTH_TOLERANCE = 0.02f;
// Sine of 10 degrees: interpolated normals may lean away from the eye by this much.
const float SURFACE_FACING_TOLERANCE = 0.17365f;
// By this much a value may be outside its range, because of half floats and filtering.
const float SURFACE_RANGE_TOLERANCE = 1e-3f;

GPU_END

#endif
