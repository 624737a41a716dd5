// SPDX-License-Identifier: Apache-2.0
// Tests the mip chains of textures.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "gbuffer/mipmaps.h"

namespace candelabra::test
{
namespace
{

using gbuffer::MipLevel;

std::vector<uint8_t> mips(const gbuffer::Texture& texture, const std::vector<MipLevel>& levels)
{
    std::vector<uint8_t> chain(chainBytes(levels));
    writeMips(texture, levels, std::as_writable_bytes(std::span(chain)));
    return chain;
}

double linearFromSrgb(double code)
{
    const double c = code / 255;
    return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}

std::vector<uint8_t> noise(uint32_t width, uint32_t height)
{
    std::mt19937 random(7);
    std::vector<uint8_t> rgba(size_t(width) * height * 4);
    for (uint8_t& byte : rgba)
        byte = uint8_t(random());
    return rgba;
}

} // namespace

TEST(Mipmaps, LevelsHalveDownToOneTexel)
{
    const auto levels = gbuffer::mipLayout(13, 4);
    ASSERT_EQ(levels.size(), 4u);
    const uint32_t levelSizes[4][2] = {{13, 4}, {6, 2}, {3, 1}, {1, 1}};
    size_t offset = 0;
    for (size_t i = 0; i < 4; ++i) {
        EXPECT_EQ(levels[i].width, levelSizes[i][0]);
        EXPECT_EQ(levels[i].height, levelSizes[i][1]);
        EXPECT_EQ(levels[i].offset, offset);
        offset += size_t(levelSizes[i][0]) * levelSizes[i][1] * 4;
    }
    EXPECT_EQ(chainBytes(levels), offset);
}

// Compares level 1 with areas integrated in double precision, for odd and even sides, sRGB and
// linear.
TEST(Mipmaps, FirstLevelIsTheExactAreaAverage)
{
    for (const auto& [width, height] : {std::pair{8u, 8u}, {7u, 5u}, {1u, 9u}, {64u, 3u}})
        for (const bool srgb : {false, true}) {
            const auto rgba = noise(width, height);
            const gbuffer::Texture texture{
                .width = width, .height = height, .rgba = rgba, .srgb = srgb};
            const auto levels = gbuffer::mipLayout(width, height);
            const auto chain = mips(texture, levels);
            const uint32_t w = levels[1].width, h = levels[1].height;
            const auto overlap = [](double a0, double a1, double b0, double b1) {
                return std::max(0.0, std::min(a1, b1) - std::max(a0, b0));
            };
            for (uint32_t y = 0; y < h; ++y)
                for (uint32_t x = 0; x < w; ++x)
                    for (uint32_t c = 0; c < 4; ++c) {
                        const bool decode = srgb && c < 3;
                        double sum = 0, area = 0;
                        for (uint32_t j = 0; j < height; ++j)
                            for (uint32_t i = 0; i < width; ++i) {
                                const double share = overlap(i, i + 1, double(x) * width / w,
                                                             double(x + 1) * width / w) *
                                                     overlap(j, j + 1, double(y) * height / h,
                                                             double(y + 1) * height / h);
                                const double code = rgba[(size_t(j) * width + i) * 4 + c];
                                sum += share * (decode ? linearFromSrgb(code) : code / 255);
                                area += share;
                            }
                        const double code = chain[levels[1].offset + (size_t(y) * w + x) * 4 + c];
                        // Tolerance: half a code on either side, and float rounding.
                        const auto value = [&](double k) {
                            return decode ? linearFromSrgb(k) : k / 255;
                        };
                        EXPECT_GE(sum / area, value(code - 0.5) - 1e-6);
                        EXPECT_LE(sum / area, value(code + 0.5) + 1e-6);
                    }
        }
}

TEST(Mipmaps, ConstantTexturesStayConstant)
{
    for (const int code : {0, 1, 77, 254, 255}) {
        const std::vector<uint8_t> rgba(size_t(37) * 21 * 4, uint8_t(code));
        const gbuffer::Texture texture{.width = 37, .height = 21, .rgba = rgba, .srgb = true};
        for (const uint8_t byte : mips(texture, gbuffer::mipLayout(37, 21)))
            ASSERT_EQ(byte, code);
    }
}

} // namespace candelabra::test
