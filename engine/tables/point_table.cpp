// SPDX-License-Identifier: Apache-2.0
#include "tables/point_table.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <span>

#include "shared/visibility_points.h"

namespace candelabra::tables
{
namespace
{

using Points = std::span<const glm::vec2>;

template <typename IsIn>
glm::uvec2 maskOf(Points points, IsIn&& isIn)
{
    uint64_t bits = 0;
    for (size_t i = 0; i < points.size(); ++i)
        bits |= uint64_t(isIn(glm::dvec2(points[i]))) << i;
    return {uint32_t(bits), uint32_t(bits >> 32u)};
}

// Returns the points whose coordinate on an axis is below the k-th of even steps from -1 to 1.
glm::uvec2 pointsBelow(Points points, int axis, uint32_t k)
{
    const double end = 2.0 * k / (gpu::POINT_PREFIXES - 1) - 1;
    return maskOf(points, [&](const glm::dvec2& p) { return p[axis] < end; });
}

// Returns the points in a stadium along u that fills the square. `ratio`: length of each round end
// over half the length of the stadium.
glm::uvec2 pointsInStadium(Points square, double ratio)
{
    return maskOf(square, [&](const glm::dvec2& p) {
        const double beyond = std::max(0.0, std::abs(p.x) - (1 - ratio)) / ratio;
        return beyond * beyond + p.y * p.y <= 1;
    });
}

} // namespace

std::vector<glm::uvec2> pointTable(uint32_t count)
{
    const Points points = count == 64 ? Points(gpu::POINTS_64) : Points(gpu::POINTS_32);
    const Points disc = points.first(count), square = points.last(count);
    std::vector<glm::uvec2> out;
    for (const glm::vec2& p : points)
        out.emplace_back(std::bit_cast<uint32_t>(p.x), std::bit_cast<uint32_t>(p.y));
    for (const Points& shape : {disc, square})
        for (const int axis : {0, 1})
            for (uint32_t k = 0; k < gpu::POINT_PREFIXES; ++k)
                out.push_back(pointsBelow(shape, axis, k));
    for (uint32_t k = 1; k <= gpu::STADIUM_RATIOS; ++k)
        out.push_back(pointsInStadium(square, double(k) / gpu::STADIUM_RATIOS));
    return out;
}

} // namespace candelabra::tables
