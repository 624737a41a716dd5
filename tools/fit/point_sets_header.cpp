// SPDX-License-Identifier: Apache-2.0
// Writes shaders/shared/visibility_points.h.
#include "fit/point_sets.h"

#include <array>

#include <fmt/format.h>

namespace candelabra::fit
{
namespace
{

using Points = std::vector<glm::dvec2>;

constexpr std::array regions = {Region::Disc, Region::Square};

const char* const beginning = R"(// SPDX-License-Identifier: Apache-2.0
// The points of a light source for which shadows are found (lib/visibility). Written by
// `candelabra_fit points`, which places the points so that an edge of a shadow across a light
// counts the right share of them. The root mean square of share of points minus share of area, over
// half-planes, is {:.4f} (64 in the disc), {:.4f} (32), {:.4f} (64 in the square) and {:.4f} (32).
// Half-planes whose edge is nearly along a side of the square count 8 times.
// A unit test (PointSets) computes it again. engine/tables/point_table.h derives sets of points
// from them.
//
// Bit i of a mask belongs to point i: bits 0..31 are in x, bits 32..63 in y. All coordinates lie
// inside (-1, 1), in units of the half axes of the facet.
#ifndef CND_SHARED_VISIBILITY_POINTS_H
#define CND_SHARED_VISIBILITY_POINTS_H

)"
                              "#include \"shared/prelude.h\"\n"
                              R"(
GPU_BEGIN

// Which points a facet has: those in the unit disc, those in the square, or only (0, 0).
const uint FACET_DISC = 0u;
const uint FACET_SQUARE = 1u;
const uint FACET_POINT = 2u;

// How many sets there are of points below a coordinate, and of points in a stadium.
const uint POINT_PREFIXES = 33u;
const uint STADIUM_RATIOS = 16u;

// clang-format off
)";

const char* const ending = R"(// clang-format on

GPU_END

#endif
)";

// Returns the definition of an array, three points per line.
std::string arrayOf(const std::array<Points, 2>& sets)
{
    const size_t count = sets[0].size(), last = 2 * count - 1;
    std::string out = fmt::format("const vec2 POINTS_{}[{}] = {{", count, 2 * count);
    for (size_t i = 0; i <= last; ++i) {
        const glm::dvec2& p = sets[i / count][i % count];
        out += fmt::format("{}vec2({:.5f}f, {:.5f}f){}", i % 3 ? " " : "\n    ", float(p.x),
                           float(p.y), i < last ? "," : "");
    }
    return out + "};\n";
}

} // namespace

std::string visibilityPointsHeader(uint32_t moves)
{
    std::array<std::array<Points, 2>, 2> sets; // 64 and 32 points; disc and square
    for (size_t i = 0; i < 2; ++i)
        for (const Region region : regions)
            sets[i][size_t(region)] = annealedPoints(region, i == 0 ? 64 : 32, moves);
    const auto error = [&](size_t i, Region region) {
        return halfPlaneError(region, sets[i][size_t(region)]);
    };
    std::string out =
        fmt::format(fmt::runtime(beginning), error(0, Region::Disc), error(1, Region::Disc),
                    error(0, Region::Square), error(1, Region::Square));
    out += "// The points in the disc, then those in the square; the same again for 32.\n";
    for (const auto& set : sets)
        out += arrayOf(set);
    return out + ending;
}

} // namespace candelabra::fit
