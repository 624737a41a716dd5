// SPDX-License-Identifier: Apache-2.0
// What crosses between the program's heat maps and their kernel.
#ifndef CND_SHARED_HEAT_MAP_H
#define CND_SHARED_HEAT_MAP_H

#include "shared/prelude.h"

GPU_BEGIN

// --- heat_map: pair image (CndLightingFrame::pairImage) -> false colours, one lane per pixel
const uint HEAT_MAP_GROUP = 8u; // x and y
const uint HEAT_MAP_PAIRS = 0u;
const uint HEAT_MAP_DISPLAY = 1u;
const uint HEAT_MAP_COLOURS = 2u; // packed RGBA8: the map, one per class, the legend row by row
const uint HEAT_MAP_STEPS = 256u;
const uint HEAT_MAP_CLASSES = 4u;
const float HEAT_MAP_MOST = 1000.0f; // lights at the end of the map, which is logarithmic in 1 + n

const uint HEAT_MAP_LISTED = 1u; // HeatMap
const uint HEAT_MAP_EVALUATED = 2u;
const uint HEAT_MAP_EFFICIENCY = 3u;
const uint HEAT_MAP_CLASS = 4u;
struct HeatMapParams {
    uvec2 size;
    uvec2 legendSize; // drawn at the lower left
    uint which;       // HEAT_MAP_*
};
GPU_SIZE(HeatMapParams, 20)

GPU_END

#endif
