// SPDX-License-Identifier: Apache-2.0
// Records of the probe of lib/visibility (probes/visibility.comp).
#ifndef CND_SHARED_VISIBILITY_PROBE_H
#define CND_SHARED_VISIBILITY_PROBE_H

#include "shared/lighting_data.h"
#include "shared/prelude.h"

GPU_BEGIN

// Specialisation constant: points per light, 64 or 32.
const uint VISIBILITY_PROBE_POINTS = 0u;
const uint VISIBILITY_PROBE_TABLE = 2u; // binding of the table of points
const uint SHEET_CELLS = 4u;            // along each side of a sheet
const uint SHEET_VERTICES = (SHEET_CELLS + 1u) * (SHEET_CELLS + 1u);

// One receiver, one light and one sheet of SHEET_CELLS^2 quads of two triangles each.
struct VisibilityProbeInput {
    vec3 position; // of the receiver, view space, m
    vec3 n, v;     // unit normal and direction to the eye
    float alpha;
    uint type;    // of the light
    vec3 toLight; // m; distant types: unit direction
    float boundingRadius;
    LightShape shape;
    mat3 viewFromLocal, localFromView; // of the sheet's instance
    vec3 localPosition;                // of the receiver
    float depthError, surfaceError;    // m
    vec3 vertices[SHEET_VERTICES];     // in rows, in the instance's space
};
GPU_SIZE(VisibilityProbeInput, 484)

struct VisibilityProbeOutput {
    uvec2 members;
    uvec2 hidden;     // by the sheet
    uvec2 inBox;      // boxPoints() of the sheet
    uint touchesCone; // 1: coneTouches() of the sheet and the points that it hides
    vec2 shares;      // visible shares
    vec3 largest;     // sums of the sizes of all numbers of the facet and its light coordinates
};
GPU_SIZE(VisibilityProbeOutput, 48)

GPU_END

#endif
