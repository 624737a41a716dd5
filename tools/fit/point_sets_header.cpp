// SPDX-License-Identifier: Apache-2.0
// Writes shaders/shared/visibility_points.h.
#include "fit/point_sets.h"

#include <array>
#include <cmath>
#include <functional>

#include <fmt/format.h>

namespace candelabra::fit
{
namespace
{

using Points = std::vector<glm::dvec2>;

constexpr std::array regions = {Region::Disc, Region::Square};
constexpr uint32_t prefixes = 33, ratios = 16;

const char* const beginning = R"(// SPDX-License-Identifier: Apache-2.0
// The points of a light source for which shadows are found (lib/visibility), and sets of them as
// bit masks. Written by `candelabra_fit points`, which places the points so that an edge of a
// shadow across a light counts the right share of them. The root mean square of share of points
// minus share of area, over half-planes, is {:.4f} (64 in the disc), {:.4f} (32), {:.4f} (64 in the
// square) and {:.4f} (32). A unit test (PointSets) computes it and the sets again.
//
// Bit i of a mask belongs to point i: bits 0..31 are in x, bits 32..63 in y. Masks of 32 points are
// one word. All coordinates lie inside (-1, 1), in units of the half axes of the facet.
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

const uint POINT_PREFIXES = 33u;
const uint STADIUM_RATIOS = 16u;

// clang-format off
)";

const char* const ending = R"(// clang-format on

GPU_END

#endif
)";

uint64_t maskOf(const Points& points, const std::function<bool(const glm::dvec2&)>& isIn)
{
    uint64_t out = 0;
    for (size_t i = 0; i < points.size(); ++i)
        out |= uint64_t(isIn(points[i])) << i;
    return out;
}

std::string wordOf(uint64_t mask, size_t bits)
{
    const std::string low = fmt::format("0x{:08X}u", uint32_t(mask));
    return bits == 32 ? low : fmt::format("uvec2({}, 0x{:08X}u)", low, uint32_t(mask >> 32u));
}

// An array of GLSL and C++ with so many elements per line.
std::string arrayOf(const std::string& head, const std::vector<std::string>& elements,
                    size_t perLine)
{
    std::string out = fmt::format("{}[{}] = {{", head, elements.size());
    for (size_t i = 0; i < elements.size(); ++i)
        out += (i % perLine ? " " : "\n    ") + elements[i] + (i + 1 < elements.size() ? "," : "");
    return out + "};\n";
}

std::string pointsOf(const std::array<Points, 2>& sets)
{
    std::vector<std::string> elements;
    for (const Points& points : sets)
        for (const glm::dvec2& p : points)
            elements.push_back(fmt::format("vec2({:.5f}f, {:.5f}f)", float(p.x), float(p.y)));
    return arrayOf(fmt::format("const vec2 POINTS_{}", sets[0].size()), elements, 3);
}

std::string prefixesOf(const std::array<Points, 2>& sets)
{
    const size_t bits = sets[0].size();
    std::vector<std::string> elements;
    for (const Points& points : sets)
        for (const int axis : {0, 1})
            for (uint32_t k = 0; k < prefixes; ++k) {
                const double end = k / 16.0 - 1;
                const auto below = [&](const glm::dvec2& p) { return p[axis] < end; };
                elements.push_back(wordOf(maskOf(points, below), bits));
            }
    const char* const type = bits == 32 ? "uint" : "uvec2";
    return arrayOf(fmt::format("const {} POINTS_BELOW_{}", type, bits), elements,
                   bits == 32 ? 6 : 3);
}

std::string stadiumsOf(const Points& square)
{
    const size_t bits = square.size();
    std::vector<std::string> elements;
    for (uint32_t i = 1; i <= ratios; ++i) {
        const double ratio = double(i) / ratios;
        const auto isIn = [&](const glm::dvec2& p) {
            const double beyond = std::max(0.0, std::abs(p.x) - (1 - ratio)) / ratio;
            return beyond * beyond + p.y * p.y <= 1;
        };
        elements.push_back(wordOf(maskOf(square, isIn), bits));
    }
    const char* const type = bits == 32 ? "uint" : "uvec2";
    return arrayOf(fmt::format("const {} STADIUM_{}", type, bits), elements, bits == 32 ? 6 : 3);
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
        out += pointsOf(set);
    out +=
        "\n// Element (shape * 2 + axis) * POINT_PREFIXES + k: the points whose coordinate on the "
        "axis is below\n// -1 + k / 16. `shape` is FACET_DISC or FACET_SQUARE, axis 0 is u, 1 is "
        "v.\n";
    for (const auto& set : sets)
        out += prefixesOf(set);
    out += "\n// Element i: the points of the square in a stadium along u that fills it. Its ends "
           "are as long as\n// (i + 1) / STADIUM_RATIOS of its half length.\n";
    for (const auto& set : sets)
        out += stadiumsOf(set[size_t(Region::Square)]);
    return out + ending;
}

} // namespace candelabra::fit
