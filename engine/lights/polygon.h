// SPDX-License-Identifier: Apache-2.0
// The outlines of polygon lights.
#pragma once

#include <array>
#include <cstdint>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "candelabra/lights.h"
#include "shared/lighting_data.h"

namespace candelabra::lighting
{

// Returns why the corners of a light cannot be used, or null. It allocates nothing.
const char* whyPolygonInvalid(const CndPolygon* polygon);

// Returns the area in the coordinates of the corners, which is > 0 if they go counterclockwise.
double polygonArea(const CndPolygon& polygon);

// A polygon as its outline is evaluated.
struct OutlinePolygon {
    glm::vec3 axisU, axisV;
    uint32_t count; // of corners
    std::array<glm::vec2, gpu::MAX_RECORD_CORNERS> corners;
};

// Returns the corners and axes of a polygon light as they are, unless the polygon is thin: less
// than a tenth as wide as it is long. The terms of both long sides of a thin polygon must cancel
// (shaders/lib/outline), which they do only if both sides are divided at the same places. So each
// side gets a corner next to every corner of the other side, and axisU goes along the longest
// diagonal.
OutlinePolygon outlinePolygon(const CndLight& light) noexcept;

// Returns the distance of the farthest corner from the light's position in metres. `light` is a
// polygon light.
float polygonRadius(const CndLight& light);

} // namespace candelabra::lighting
