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
// Packed RGBA8: the colours of the map, one colour per class, the pixels of the legend row by row.
// For HEAT_MAP_SHADOW the classes are: no light is asked for; lights that are seen wholly, in part
// and not at all, whose colours are mixed by their shares.
const uint HEAT_MAP_COLOURS = 2u;
const uint HEAT_MAP_STEPS = 256u; // colours of the map
const uint HEAT_MAP_CLASSES = 4u;
// The number of lights at the end of the map, which is logarithmic in 1 + lights.
const float HEAT_MAP_MOST = 1000.0f;

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
};
GPU_SIZE(HeatMapParams, 20)

GPU_END

#endif
