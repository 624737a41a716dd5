// SPDX-License-Identifier: Apache-2.0
// The cones of spots that files describe.
#pragma once

#include "candelabra/candelabra.h"

namespace candelabra::app
{

// Sets the cone of a spot to half angles in radians, which need not be valid, and returns whether
// they are those of the light now, but for rounding. Else the light has the nearest cone that the
// library takes: exporters write equal angles for a hard edge, which then gets the smallest width
// that there is, CND_MIN_CONE_EDGE.
bool setCone(double inner, double outer, CndLight& light);

} // namespace candelabra::app
