// SPDX-License-Identifier: Apache-2.0
// The points of lights for which shadows are found (shaders/shared/visibility_points.h), as kernels
// read them.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec2.hpp>

namespace candelabra::tables
{

// Returns the table of shaders/lib/visibility/facet_points.glsl for 64 or 32 points, 2 KB: the
// points in the disc and in the square as the bits of floats, the prefixes of both, and the
// stadiums.
std::vector<glm::uvec2> pointTable(uint32_t count);

} // namespace candelabra::tables
