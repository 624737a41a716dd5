// SPDX-License-Identifier: Apache-2.0
#include "scene/polygons.h"

#include <array>
#include <cassert>
#include <cmath>
#include <iterator>
#include <numbers>

namespace candelabra::app
{

namespace
{

constexpr uint32_t fewest = 3;

constexpr CndPolygon irregular[] = {
    {3, {{-1, -1}, {1, -0.9f}, {-0.7f, 1}}},
    {4, {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}},
    {5, {{-1, -1}, {0.3f, -1}, {1, 0}, {0.3f, 1}, {-1, 1}}},
    {4, {{-1, -0.4f}, {1, -1}, {1, 1}, {-1, 0.2f}}},
    {7, {{-1, -0.2f}, {-0.2f, -1}, {1, -0.6f}, {1, 0}, {0.9f, 0.5f}, {0.6f, 1}, {-0.6f, 0.8f}}},
    {8,
     {{-1, -0.8f},
      {-0.9f, -1},
      {0.7f, -1},
      {1, -0.2f},
      {1, 0.3f},
      {0.5f, 1},
      {-0.3f, 1},
      {-1, 0.6f}}},
};
static_assert(std::size(irregular) == CND_MAX_CORNERS - fewest + 1);

} // namespace

const CndPolygon* regularPolygon(uint32_t corners)
{
    static const auto polygons = [] {
        std::array<CndPolygon, CND_MAX_CORNERS + 1> out{};
        for (uint32_t count = fewest; count <= CND_MAX_CORNERS; ++count) {
            out[count].cornerCount = count;
            for (uint32_t i = 0; i < count; ++i) {
                const double angle = 2 * std::numbers::pi * i / count;
                out[count].corners[i][0] = float(std::cos(angle));
                out[count].corners[i][1] = float(std::sin(angle));
            }
        }
        return out;
    }();
    assert(corners >= fewest && corners <= CND_MAX_CORNERS);
    return &polygons[corners];
}

const CndPolygon* somePolygon(uint32_t index)
{
    const uint32_t which = index / 2 % uint32_t(std::size(irregular));
    return index % 2 ? &irregular[which] : regularPolygon(fewest + which);
}

} // namespace candelabra::app
