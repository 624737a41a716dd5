// SPDX-License-Identifier: Apache-2.0
// The outlines of polygon lights.
#pragma once

#include "candelabra/lights.h"

namespace candelabra::lighting
{

// Returns why the corners of a light cannot be used, or null. It allocates nothing.
const char* whyPolygonInvalid(const CndPolygon* polygon);

// Returns the area in the coordinates of the corners, which is > 0 if they go counterclockwise.
double polygonArea(const CndPolygon& polygon);

// Returns the distance of the farthest corner from the light's position in metres. `light` is a
// polygon light.
float polygonRadius(const CndLight& light);

} // namespace candelabra::lighting
