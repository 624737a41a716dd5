// SPDX-License-Identifier: Apache-2.0
#include "render/legend.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>

#include <glm/common.hpp>

namespace candelabra::app
{
namespace
{

constexpr uint32_t glyphWidth = 3, glyphHeight = 5, advance = 4;
constexpr uint32_t margin = 3, barHeight = 6, barWidth = 160, swatch = 5;

const glm::vec3 paper(0.08f), ink(0.92f);

// The glyph of a character: five rows of three dots, with the highest bit at the upper left.
uint16_t glyphOf(char c)
{
    constexpr std::array<uint16_t, 10> digits = {075557, 026227, 071747, 071717, 055711,
                                                 074717, 074757, 071111, 075757, 075717};
    constexpr std::array<uint16_t, 26> letters = {
        025755, 065656, 034443, 065556, 074647, 074644, 034553, 055755, 072227,
        011152, 055655, 044447, 057755, 065555, 025552, 065644, 025563, 065655,
        034216, 072222, 055557, 055552, 055775, 055255, 055222, 071247};
    const unsigned char u = static_cast<unsigned char>(c);
    if (std::isdigit(u))
        return digits[size_t(c - '0')];
    if (std::isalpha(u))
        return letters[size_t(std::toupper(u) - 'A')];
    return c == '.' ? 000002 : c == ',' ? 000024 : c == '%' ? 051245 : c == '+' ? 002720 : 0;
}

class Canvas
{
public:
    // `width` and `height` are in dots of `scale` pixels a side.
    Canvas(uint32_t width, uint32_t height, uint32_t scale)
        : scale_(scale), legend_{width * scale, height * scale, {}}
    {
        legend_.pixels.assign(size_t(legend_.width) * legend_.height, packed(paper));
    }
    void dot(uint32_t x, uint32_t y, glm::vec3 colour)
    {
        for (uint32_t j = y * scale_; j < (y + 1) * scale_; ++j)
            for (uint32_t i = x * scale_; i < (x + 1) * scale_; ++i)
                if (i < legend_.width && j < legend_.height)
                    legend_.pixels[size_t(j) * legend_.width + i] = packed(colour);
    }
    void text(uint32_t x, uint32_t y, const std::string& what)
    {
        for (const char c : what) {
            const uint16_t glyph = glyphOf(c);
            for (uint32_t row = 0; row < glyphHeight; ++row)
                for (uint32_t column = 0; column < glyphWidth; ++column)
                    if (glyph >> ((glyphHeight - 1 - row) * glyphWidth + glyphWidth - 1 - column) &
                        1)
                        dot(x + column, y + row, ink);
            x += advance;
        }
    }
    Legend take() { return std::move(legend_); }

private:
    uint32_t scale_;
    Legend legend_;
};

uint32_t widthOf(const std::string& text)
{
    return uint32_t(text.size()) * advance;
}

} // namespace

// The polynomial is by M. Zucker, who put it into the public domain.
glm::vec3 viridis(float place)
{
    const glm::vec3 c[] = {{0.2777273272f, 0.0054073445f, 0.3340998053f},
                           {0.1050930431f, 1.4046135299f, 1.3845901627f},
                           {-0.3308618287f, 0.2148475595f, 0.0950951630f},
                           {-4.6342304988f, -5.7991009734f, -19.3324409563f},
                           {6.2282699363f, 14.1799333668f, 56.6905526007f},
                           {4.7763849977f, -13.7451453777f, -65.3530326334f},
                           {-5.4354558559f, 4.6458526127f, 26.3124352496f}};
    glm::vec3 out(0);
    for (int i = 6; i >= 0; --i)
        out = out * place + c[i];
    return glm::clamp(out, 0.0f, 1.0f);
}

uint32_t packed(glm::vec3 srgb)
{
    uint32_t out = 0xFF000000u;
    for (int i = 0; i < 3; ++i)
        out |= uint32_t(std::lround(srgb[i] * 255)) << (8 * i);
    return out;
}

Legend barLegend(const std::string& title, const std::vector<LegendMark>& marks, uint32_t scale)
{
    const uint32_t barTop = margin + glyphHeight + 2, textTop = barTop + barHeight + 2;
    const uint32_t width = std::max(barWidth, widthOf(title));
    Canvas canvas(width + 2 * margin, textTop + glyphHeight + margin, scale);
    canvas.text(margin, margin, title);
    for (uint32_t x = 0; x < barWidth; ++x)
        for (uint32_t y = 0; y < barHeight; ++y)
            canvas.dot(margin + x, barTop + y, viridis(float(x) / (barWidth - 1)));
    for (const LegendMark& mark : marks) {
        const uint32_t x = margin + uint32_t(std::lround(mark.place * (barWidth - 1)));
        canvas.dot(x, barTop + barHeight, ink);
        canvas.text(std::min(x, margin + barWidth - widthOf(mark.text)), textTop, mark.text);
    }
    return canvas.take();
}

Legend listLegend(const std::string& title, const std::vector<LegendEntry>& entries, uint32_t scale)
{
    uint32_t width = widthOf(title);
    for (const LegendEntry& entry : entries)
        width = std::max(width, swatch + 2 + widthOf(entry.text));
    const uint32_t line = glyphHeight + 2;
    Canvas canvas(width + 2 * margin, 2 * margin + line * uint32_t(entries.size() + 1), scale);
    canvas.text(margin, margin, title);
    uint32_t y = margin + line;
    for (const LegendEntry& entry : entries) {
        for (uint32_t j = 0; j < swatch; ++j)
            for (uint32_t i = 0; i < swatch; ++i)
                canvas.dot(margin + i, y + j, entry.colour);
        canvas.text(margin + swatch + 2, y, entry.text);
        y += line;
    }
    return canvas.take();
}

} // namespace candelabra::app
