// SPDX-License-Identifier: Apache-2.0
// Outlines for polygon lights. They live as long as the program, so that lights can refer to them.
#pragma once

#include "candelabra/candelabra.h"

namespace candelabra::app
{

// Returns the polygon with 3 to CND_MAX_CORNERS corners on the unit circle, the first one on axisU,
// at equal distances.
const CndPolygon* regularPolygon(uint32_t corners);

// Returns one of some polygons of all numbers of corners, regular and irregular ones in turn. Every
// index is valid.
const CndPolygon* somePolygon(uint32_t index);

} // namespace candelabra::app
