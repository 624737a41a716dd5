// SPDX-License-Identifier: Apache-2.0
// The colours of heat maps and the legend that says what they mean.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

namespace candelabra::app
{

// viridis at 0..1: dark to light in steps that look even (Smith and van der Walt 2015; polynomial
// fit), sRGB.
glm::vec3 viridis(float place);

// A small picture, RGBA8 packed with red lowest, rows from the top.
struct Legend {
    uint32_t width = 0, height = 0;
    std::vector<uint32_t> pixels;
};
uint32_t packed(glm::vec3 srgb);

struct LegendMark {
    float place; // 0..1 along the bar
    std::string text;
};
// A bar of all colours with marks under it; `scale`: pixels per dot of the letters, 1 or more.
Legend barLegend(const std::string& title, const std::vector<LegendMark>& marks, uint32_t scale);

struct LegendEntry {
    glm::vec3 colour;
    std::string text;
};
Legend listLegend(const std::string& title, const std::vector<LegendEntry>& entries,
                  uint32_t scale);

} // namespace candelabra::app
