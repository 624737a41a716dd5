// SPDX-License-Identifier: Apache-2.0
// The colours of heat maps, and the legends that explain them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

namespace candelabra::app
{

// The sRGB colour of the map "viridis" (Smith and van der Walt 2015; a polynomial fit) at `place`,
// 0 to 1: from dark to light, in steps that look even.
glm::vec3 viridis(float place);

// A small picture: RGBA8 with red in the lowest byte, rows from the top.
struct Legend {
    uint32_t width = 0, height = 0;
    std::vector<uint32_t> pixels;
};
uint32_t packed(glm::vec3 srgb);

struct LegendMark {
    float place; // 0..1 along the bar
    std::string text;
};
// Draws a bar of all colours with marks under it. Letters are made of dots of `scale` pixels a
// side, at least 1.
Legend barLegend(const std::string& title, const std::vector<LegendMark>& marks, uint32_t scale);

struct LegendEntry {
    glm::vec3 colour;
    std::string text;
};
Legend listLegend(const std::string& title, const std::vector<LegendEntry>& entries,
                  uint32_t scale);

} // namespace candelabra::app
