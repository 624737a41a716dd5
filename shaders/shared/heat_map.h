// SPDX-License-Identifier: Apache-2.0
// Data that the program's heat maps and their kernel share.
#ifndef CND_SHARED_HEAT_MAP_H
#define CND_SHARED_HEAT_MAP_H

#include "shared/prelude.h"

GPU_BEGIN

// --- heat_map: turns the pair image (CndLightingFrame::pairImage), or for HEAT_MAP_SHADOW the
// shadow image (CndLightingFrame::shadowImage), into false colours, one lane per pixel
const uint HEAT_MAP_GROUP = 8u; // x and y
const uint HEAT_MAP_PAIRS = 0u;
const uint HEAT_MAP_DISPLAY = 1u;
// Packed RGBA8: the colours of the map and one colour per class. Then the numbers of lights at the
// ends of the scales, and the pixels of the legends row by row, one legend per scale. Maps that do
// not count lights have one legend alone. For HEAT_MAP_SHADOW the classes are: no light is asked
// for; lights that are seen wholly, in part and not at all, whose colours are mixed by their
// shares.
const uint HEAT_MAP_COLOURS = 2u;
const uint HEAT_MAP_STEPS = 256u; // colours of the map
const uint HEAT_MAP_CLASSES = 4u;
const uint HEAT_MAP_SCALES = 18u;
// For each scale, the number of pixels with a surface that fit it but not the next smaller scale.
const uint HEAT_MAP_COUNTS = 3u;

// The program's enum HeatMap.
const uint HEAT_MAP_LISTED = 1u;
const uint HEAT_MAP_EVALUATED = 2u;
const uint HEAT_MAP_EFFICIENCY = 3u;
const uint HEAT_MAP_CLASS = 4u;
const uint HEAT_MAP_SHADOW = 5u;
struct HeatMapParams {
    uvec2 size;
    uvec2 legendSize; // drawn at the lower left
    uint which;       // HEAT_MAP_*
    uint onlyCounts;  // 1: counts pixels and paints nothing
};
GPU_SIZE(HeatMapParams, 24)

GPU_END

#endif
