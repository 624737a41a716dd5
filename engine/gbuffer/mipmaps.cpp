// SPDX-License-Identifier: Apache-2.0
#include "gbuffer/mipmaps.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

namespace candelabra::gbuffer
{
namespace
{

constexpr size_t channels = 4;

// Decodes an sRGB code, 0..255, not necessarily an integer (IEC 61966-2-1).
double linearFromSrgb(double code)
{
    const double c = code / 255.0;
    return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}

// Converts between 8-bit codes and linear values; rounds to the nearest code in the encoded space.
class Encoding
{
public:
    explicit Encoding(bool srgb)
    {
        const auto decode = [srgb](double code) {
            return float(srgb ? linearFromSrgb(code) : code / 255.0);
        };
        for (int i = 0; i < 256; ++i)
            values_[i] = decode(i);
        for (int i = 0; i < 255; ++i)
            limits_[i] = decode(i + 0.5);
    }
    float decode(uint8_t code) const { return values_[code]; }
    uint8_t encode(float value) const
    {
        return uint8_t(std::upper_bound(limits_.begin(), limits_.end(), value) - limits_.begin());
    }

private:
    std::array<float, 256> values_;
    std::array<float, 255> limits_; // limits_[i]: the linear value from which on a value is rounded
                                    // to code i + 1
};

// The source texels under one destination texel along one axis, and their weights.
struct Taps {
    uint32_t first, count;
    float weights[3];
};

// Returns the taps for halving `n` texels, rounded down. For odd n = 2m+1 the m destination texels
// are (2m+1)/m texels wide, so texels 2i, 2i+1, 2i+2 have the weights (m-i, m, i+1) / (2m+1).
std::vector<Taps> halvingTaps(uint32_t n)
{
    if (n == 1)
        return {{0, 1, {1}}};
    const uint32_t m = n / 2;
    std::vector<Taps> taps(m);
    for (uint32_t i = 0; i < m; ++i) {
        taps[i] = {2 * i, 2, {0.5f, 0.5f}};
        if (n % 2)
            taps[i] = {
                2 * i, 3, {float(m - i) / float(n), float(m) / float(n), float(i + 1) / float(n)}};
    }
    return taps;
}

// Halves an image. `read(x, y, channel)` returns the source in linear space; the result has 4
// floats per texel.
template <typename Read>
std::vector<float> halvedImage(uint32_t width, uint32_t height, const Read& read)
{
    const std::vector<Taps> columns = halvingTaps(width), rows = halvingTaps(height);
    std::vector<float> result(columns.size() * rows.size() * channels);
    float* out = result.data();
    for (const Taps& row : rows)
        for (const Taps& column : columns)
            for (size_t c = 0; c < channels; ++c) {
                float sum = 0;
                for (uint32_t j = 0; j < row.count; ++j)
                    for (uint32_t i = 0; i < column.count; ++i)
                        sum += row.weights[j] * column.weights[i] *
                               read(column.first + i, row.first + j, c);
                *out++ = sum;
            }
    return result;
}

} // namespace

std::vector<MipLevel> mipLayout(uint32_t width, uint32_t height)
{
    std::vector<MipLevel> levels{{width, height, 0}};
    while (levels.back().width > 1 || levels.back().height > 1) {
        const MipLevel& last = levels.back();
        levels.push_back(
            {std::max(last.width / 2, 1u), std::max(last.height / 2, 1u), chainBytes(levels)});
    }
    return levels;
}

size_t chainBytes(const std::vector<MipLevel>& levels)
{
    const MipLevel& last = levels.back();
    return last.offset + size_t(last.width) * last.height * channels;
}

void writeMips(const Texture& texture, const std::vector<MipLevel>& levels,
               std::span<std::byte> chain)
{
    std::memcpy(chain.data(), texture.rgba.data(), texture.rgba.size());
    if (levels.size() == 1)
        return;
    const Encoding color(texture.srgb), alpha(false);
    const Encoding* const encodings[channels] = {&color, &color, &color, &alpha};
    std::vector<float> level =
        halvedImage(texture.width, texture.height, [&](uint32_t x, uint32_t y, size_t c) {
            return encodings[c]->decode(
                texture.rgba[(size_t(y) * texture.width + x) * channels + c]);
        });
    for (size_t k = 1; k < levels.size(); ++k) {
        std::byte* const out = chain.data() + levels[k].offset;
        for (size_t i = 0; i < level.size(); ++i)
            out[i] = std::byte(encodings[i % channels]->encode(level[i]));
        if (k + 1 < levels.size())
            level = halvedImage(levels[k].width, levels[k].height,
                                [&, above = level.data()](uint32_t x, uint32_t y, size_t c) {
                                    return above[(size_t(y) * levels[k].width + x) * channels + c];
                                });
    }
}

} // namespace candelabra::gbuffer
