// SPDX-License-Identifier: Apache-2.0
// The legends of heat maps, which are drawn in the lower left corner of the picture.
#pragma once

#include "io/parse.h"
#include "render/heat_map.h"
#include "render/legend.h"

namespace candelabra::app
{

// Returns the legend for a picture of `size` pixels. `which` must not be HeatMap::None. `most`: the
// number of lights at the end of the scale, if the map counts lights; all have the same size.
Legend heatMapLegend(HeatMap which, PixelSize size, uint32_t most);

} // namespace candelabra::app
