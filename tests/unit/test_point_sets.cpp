// SPDX-License-Identifier: Apache-2.0
// Tests that the points of lights (shaders/shared/visibility_points.h) are as good as their header
// says, and that the table of sets of points (engine/tables/point_table.h) follows from them.
#include <bit>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "fit/point_sets.h"
#include "shared/visibility_points.h"
#include "tables/point_table.h"

namespace candelabra::test
{
namespace
{

using fit::Region;

std::vector<glm::dvec2> committed(Region region, uint32_t count)
{
    std::vector<glm::dvec2> out;
    const uint32_t first = region == Region::Disc ? 0 : count;
    for (uint32_t i = 0; i < count; ++i)
        out.emplace_back(count == 64 ? gpu::POINTS_64[first + i] : gpu::POINTS_32[first + i]);
    return out;
}

uint64_t bitsOf(const glm::uvec2& mask)
{
    return uint64_t(mask.y) << 32u | mask.x;
}

} // namespace

TEST(PointSets, HaveTheErrorsOfTheirHeader)
{
    EXPECT_NEAR(fit::halfPlaneError(Region::Disc, committed(Region::Disc, 64)), 0.0104, 5.1e-5);
    EXPECT_NEAR(fit::halfPlaneError(Region::Disc, committed(Region::Disc, 32)), 0.0182, 5.1e-5);
    EXPECT_NEAR(fit::halfPlaneError(Region::Square, committed(Region::Square, 64)), 0.0087, 5.1e-5);
    EXPECT_NEAR(fit::halfPlaneError(Region::Square, committed(Region::Square, 32)), 0.0156, 5.1e-5);
}

// A short search already comes near, so the long one that made the committed points is right too.
TEST(PointSets, AreImprovedByTheSearch)
{
    for (const Region region : {Region::Disc, Region::Square})
        for (const uint32_t count : {64u, 32u}) {
            const double error =
                fit::halfPlaneError(region, fit::annealedPoints(region, count, 20000));
            EXPECT_LT(error, fit::halfPlaneError(region, fit::regularPoints(region, count)));
            EXPECT_GE(error, 0.995 * fit::halfPlaneError(region, committed(region, count)));
            EXPECT_LT(error, 1.15 * fit::halfPlaneError(region, committed(region, count)));
        }
}

TEST(PointSets, LieInsideTheirRegion)
{
    for (const uint32_t count : {64u, 32u}) {
        for (const glm::dvec2& p : committed(Region::Disc, count))
            EXPECT_LT(std::hypot(p.x, p.y), 1);
        for (const glm::dvec2& p : committed(Region::Square, count))
            EXPECT_LT(std::max(std::abs(p.x), std::abs(p.y)), 1);
    }
}

TEST(PointSets, PrefixesHoldThePointsBelow)
{
    for (const uint32_t count : {64u, 32u})
        for (const uint32_t shape : {gpu::FACET_DISC, gpu::FACET_SQUARE})
            for (const uint32_t axis : {0u, 1u})
                for (uint32_t k = 0; k < gpu::POINT_PREFIXES; ++k) {
                    const auto points =
                        committed(shape == gpu::FACET_DISC ? Region::Disc : Region::Square, count);
                    uint64_t below = 0;
                    for (uint32_t i = 0; i < count; ++i)
                        below |= uint64_t(points[i][int(axis)] < k / 16.0 - 1) << i;
                    const uint32_t at = (shape * 2 + axis) * gpu::POINT_PREFIXES + k;
                    EXPECT_EQ(below, bitsOf(tables::pointTable(count)[2 * count + at]));
                }
}

TEST(PointSets, StadiumsHoldThePointsInThem)
{
    for (const uint32_t count : {64u, 32u})
        for (uint32_t k = 1; k <= gpu::STADIUM_RATIOS; ++k) {
            const double end = double(k) / gpu::STADIUM_RATIOS; // length of a round end
            const auto points = committed(Region::Square, count);
            uint64_t in = 0;
            for (uint32_t i = 0; i < count; ++i) {
                const double x = std::abs(points[i].x), y = std::abs(points[i].y);
                in |= uint64_t(x <= 1 - end || std::hypot((x - 1 + end) / end, y) <= 1) << i;
            }
            const uint32_t at = 4 * gpu::POINT_PREFIXES + k - 1;
            EXPECT_EQ(in, bitsOf(tables::pointTable(count)[2 * count + at]));
        }
}

} // namespace candelabra::test
