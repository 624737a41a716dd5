// SPDX-License-Identifier: Apache-2.0
// The points of light sources that shadows are found for (shaders/shared/visibility_points.h), and
// the search that places them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

namespace candelabra::fit
{

// The unit disc, or the square from -1 to 1.
enum class Region { Disc, Square };

// What the edge of an occluder does wrong: the root mean square, over half-planes, of the share of
// the points in a half-plane minus the share of the region's area in it. The half-planes have 96
// directions and 96 offsets, which divide the region's extent in their direction evenly. Those with
// an edge within 4 degrees of a side of the square count 8 times.
double halfPlaneError(Region region, const std::vector<glm::dvec2>& points);

// Regular points from which the search starts: Vogel's spiral in the disc (Vogel 1979, "A better
// way to construct the sunflower head"), and the sequence R2 of the plastic number in the square
// (Roberts 2018, "The Unreasonable Effectiveness of Quasirandom Sequences").
std::vector<glm::dvec2> regularPoints(Region region, uint32_t count);

// Moves the points until halfPlaneError is small, by simulated annealing (Kirkpatrick, Gelatt,
// Vecchi 1983). The results are sorted by x, are multiples of 1e-5 as floats, and lie inside the
// region. The same number of moves gives the same points.
std::vector<glm::dvec2> annealedPoints(Region region, uint32_t count, uint32_t moves);

// Returns the text of shaders/shared/visibility_points.h with the points of annealedPoints().
std::string visibilityPointsHeader(uint32_t moves);

} // namespace candelabra::fit
