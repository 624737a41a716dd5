// SPDX-License-Identifier: Apache-2.0
// Tests the bloom on pictures of single bright pixels, on values that are no light, and on the
// hall.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <iostream>
#include <limits>
#include <numbers>
#include <numeric>

#include "generate/generators.h"
#include "gpu/fill_image.h"
#include "harness/gpu_fixture.h"
#include "measure/frame/frames.h"
#include "render/bloom.h"
#include "render/camera.h"
#include "render/readback.h"

using namespace candelabra;
using namespace candelabra::app;

namespace
{

// Radiance, grey, rows from the top.
struct Grey {
    PixelSize size;
    std::vector<float> values;

    explicit Grey(PixelSize s, float value = 0) : size(s), values(size_t(s.width) * s.height, value)
    {
    }
    float& at(uint32_t x, uint32_t y) { return values[size_t(y) * size.width + x]; }
    float at(uint32_t x, uint32_t y) const { return values[size_t(y) * size.width + x]; }
    double sum() const { return std::accumulate(values.begin(), values.end(), 0.0); }
};

class BloomTest : public test::GpuTest
{
protected:
    // Returns the picture with bloom. Red, green and blue hold once, twice and four times the
    // picture, which must remain so, bit for bit.
    Grey bloomed(const Grey& picture, float share) const
    {
        const uint32_t width = picture.size.width, height = picture.size.height;
        std::vector<glm::vec4> texels;
        for (const float value : picture.values)
            texels.emplace_back(value, 2 * value, 4 * value, 1);
        const gpu::Buffer data = upload("picture", texels);
        const gpu::Image radiance =
            gpu::createImage(device(), "radiance", VK_FORMAT_R32G32B32A32_SFLOAT, width, height,
                             VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT, colour);
        Bloom bloom(device(), picture.size, 1);
        const gpu::Buffer out = readback("bloomed", texels.size() * sizeof(glm::vec4));
        context().submitAndWait([&](VkCommandBuffer cmd) {
            test::fillImage(cmd, data, radiance.image.get(), width, height);
            bloom.record(cmd, 0, radiance.view.get(), share);
        });
        Grey result(picture.size);
        const std::vector<uint8_t> bytes =
            readTexels(context(), bloom.result(), colour, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                       {{0, 0}, {width, height}}, sizeof(glm::vec4));
        std::memcpy(texels.data(), bytes.data(), bytes.size());
        for (size_t i = 0; i < texels.size(); ++i) {
            result.values[i] = texels[i].r;
            if (std::isfinite(texels[i].b)) {
                EXPECT_EQ(texels[i].g, 2 * texels[i].r) << i;
                EXPECT_EQ(texels[i].b, 4 * texels[i].r) << i;
            }
        }
        return result;
    }

    static constexpr VkImageAspectFlags colour = VK_IMAGE_ASPECT_COLOR_BIT;
};

const PixelSize bloomSizes[] = {{1, 1},   {1, 40},  {40, 1},   {2, 3},    {5, 5},
                                {63, 17}, {64, 64}, {161, 91}, {320, 180}};

} // namespace

// The sum of all pixels stays the same wherever the light is, also at the borders.
TEST_F(BloomTest, KeepsTheLightOfThePicture)
{
    for (const PixelSize size : bloomSizes)
        for (const auto& [x, y] : {std::pair{0u, 0u},
                                   {size.width / 2, size.height / 2},
                                   {size.width - 1, size.height / 3},
                                   {size.width / 3, size.height - 1}}) {
            Grey picture(size);
            picture.at(x, y) = 5000;
            for (const float share : {0.04f, 0.5f, 1.0f}) {
                const Grey result = bloomed(picture, share);
                EXPECT_NEAR(result.sum() / 5000, 1, 2e-5)
                    << size.width << "x" << size.height << " at " << x << "," << y;
                EXPECT_GE(*std::ranges::min_element(result.values), 0);
                // At least what is not scattered stays.
                EXPECT_GE(result.at(x, y), (1 - share) * 5000 * (1 - 1e-6f));
            }
        }
}

// A wall that fills the picture stays as it is, up to its borders.
TEST_F(BloomTest, KeepsAFlatPicture)
{
    for (const PixelSize size : bloomSizes)
        for (const float value : bloomed(Grey(size, 3), 0.7f).values)
            ASSERT_NEAR(value, 3, 3e-6) << size.width << "x" << size.height;
}

// Pictures that are mirrored or transposed give results that are.
TEST_F(BloomTest, IsSymmetric)
{
    for (const PixelSize size : {PixelSize{64, 64}, {61, 61}, {90, 90}}) {
        Grey picture(size), mirrored(size), transposed(size);
        const uint32_t last = size.width - 1;
        for (const auto& [x, y, value] : {std::tuple{13u, 29u, 1000.f}, {40u, 5u, 30.f}}) {
            picture.at(x, y) = value;
            mirrored.at(last - x, y) = value;
            transposed.at(y, x) = value;
        }
        const Grey one = bloomed(picture, 0.5f), two = bloomed(mirrored, 0.5f),
                   three = bloomed(transposed, 0.5f);
        for (uint32_t y = 0; y < size.height; ++y)
            for (uint32_t x = 0; x < size.width; ++x) {
                ASSERT_NEAR(two.at(last - x, y) / one.at(x, y), 1, 1e-5) << x << "," << y;
                ASSERT_NEAR(three.at(y, x) / one.at(x, y), 1, 1e-5) << x << "," << y;
            }
    }
}

// The light falls off with the distance as it does in eyes (measured: 1.10 to 1.42 times theirs,
// because less than theirs is within a pixel), nearly the same in all directions and wherever the
// lamp is, so that bloom does not flicker when things move by parts of a texel of some level.
TEST_F(BloomTest, FallsOffAsInEyes)
{
    constexpr PixelSize size{256, 256};
    // The equation of the CIE (render/bloom.cpp) over its integral from 0.1 degrees on, per pixel.
    const auto eye = [&](double pixels) {
        const double degrees = pixels * 40 / size.height, area = std::pow(40.0 / size.height, 2);
        return (10 / std::pow(degrees, 3) + 5 / std::pow(degrees, 2)) * area /
               (2 * std::numbers::pi * (10 / 0.1 + 5 * std::log(15 / 0.1)));
    };
    for (const uint32_t at : {120u, 121u, 124u, 127u, 128u}) {
        Grey picture(size);
        picture.at(at, at) = 1;
        const Grey result = bloomed(picture, 1);
        double least = 1e9, most = 0;
        for (const double distance : {6.0, 12.0, 24.0, 48.0}) {
            double low = 1e9, high = 0, sum = 0;
            for (int i = 0; i < 16; ++i) {
                const double angle = i * std::numbers::pi / 8;
                const int dx = int(std::lround(distance * std::cos(angle)));
                const int dy = int(std::lround(distance * std::sin(angle)));
                const double value = double(result.at(at + dx, at + dy)) / eye(std::hypot(dx, dy));
                low = std::min(low, value);
                high = std::max(high, value);
                sum += value / 16;
            }
            std::cout << at << ", " << distance << " pixels: " << sum << " of the eye's, " << low
                      << " to " << high << "\n";
            EXPECT_LT(high / low, 1.8) << at << ", " << distance;
            least = std::min(least, sum);
            most = std::max(most, sum);
        }
        EXPECT_GT(least, 0.9);
        EXPECT_LT(most, 1.6);
    }
}

TEST_F(BloomTest, SpreadsFiniteLightAlone)
{
    constexpr float infinity = std::numeric_limits<float>::infinity();
    for (const float bad : {std::numeric_limits<float>::quiet_NaN(), infinity, -infinity, -5.0f}) {
        Grey picture({33, 20}, 2);
        picture.at(7, 9) = bad;
        Grey without = picture;
        without.at(7, 9) = 0;
        const Grey result = bloomed(picture, 0.3f), expected = bloomed(without, 0.3f);
        for (uint32_t y = 0; y < 20; ++y)
            for (uint32_t x = 0; x < 33; ++x)
                if (x != 7 || y != 9) {
                    ASSERT_EQ(result.at(x, y), expected.at(x, y)) << x << "," << y;
                }
        if (std::isfinite(bad))
            EXPECT_NEAR(result.at(7, 9), 0.7f * bad + expected.at(7, 9), 1e-5);
        else // its bits are those of NaN or of the same infinity
            EXPECT_TRUE(std::isnan(bad) ? std::isnan(result.at(7, 9)) : result.at(7, 9) == bad);
    }
    // Beyond the largest half float, and near the largest float.
    for (const float bright : {65504.0f, 1e6f, 1e20f, 1e37f}) {
        for (const float value : bloomed(Grey({33, 20}, bright), 0.5f).values)
            ASSERT_NEAR(value / bright, 1, 1e-6);
        Grey picture({33, 20});
        picture.at(0, 0) = bright;
        for (const float value : bloomed(picture, 1).values)
            ASSERT_TRUE(std::isfinite(value) && value >= 0) << value;
    }
}

TEST_F(BloomTest, SharesAddUpAtAnySize)
{
    for (const PixelSize size : bloomSizes) {
        const std::vector<double> shares = bloomShares(size);
        EXPECT_NEAR(std::accumulate(shares.begin(), shares.end(), 0.0), 1, 1e-12);
        EXPECT_GE(std::ranges::min(shares), 0);
    }
    // In a picture of twice the width and height, a level spreads as much as the one before it did.
    const std::vector<double> small = bloomShares({1280, 720}), large = bloomShares({2560, 1440});
    ASSERT_EQ(large.size(), small.size() + 1);
    for (size_t k = 2; k < small.size(); ++k)
        EXPECT_NEAR(large[k + 1] / small[k], 1, 0.05) << k;
}

TEST_F(BloomTest, OfFramesChangesTheDisplayAlone)
{
    const Scene scene = generateHall({.lights = 50});
    FrameOptions frame{.camera = selectCamera(scene, "")};
    cndDefaultExposureSettings(&frame.exposure);
    Renderer renderer(context(), scene,
                      {.size = {95, 54}, .specularMethods = 1u << frame.specular});
    const auto draw = [&](float bloom, uint32_t samples = 1) {
        frame.bloom = bloom;
        renderFrames(context(), renderer, frame, {.warmUp = 0, .samples = samples}, false, [] {});
        return readDisplay(context(), renderer);
    };
    const auto skipped = [&] {
        const std::vector<CndPassPlan> plan = renderer.stats(0).plan;
        const auto at = std::ranges::find(plan, std::string("bloom_up"), &CndPassPlan::name);
        return at == plan.end() ? "no such pass" : at->skipped ? at->skipped : "";
    };
    const auto hasTime = [&] {
        return std::ranges::any_of(renderer.stats(0).passes, [](const PassTime& pass) {
            return pass.name == "bloom_down" && pass.ms > 0;
        });
    };
    const auto before = draw(0);
    const Image radiance = readRadiance(context(), renderer);
    const FrameStats stats = renderer.stats(0);
    EXPECT_STREQ(skipped(), "it is off");
    EXPECT_FALSE(hasTime());
    const auto with = draw(0.1f);
    EXPECT_STREQ(skipped(), "");
    EXPECT_TRUE(hasTime());
    EXPECT_NE(with, before);
    EXPECT_EQ(readRadiance(context(), renderer).pixels, radiance.pixels);
    EXPECT_EQ(renderer.stats(0).exposure.exposure, stats.exposure.exposure);
    EXPECT_TRUE(std::ranges::equal(renderer.stats(0).exposure.histogram, stats.exposure.histogram));
    EXPECT_EQ(draw(0.1f), with);
    EXPECT_EQ(draw(0), before);
    // With several samples, each has bloom.
    const auto averaged = draw(0, 4), averagedWith = draw(0.1f, 4);
    EXPECT_NE(averagedWith, averaged);
    EXPECT_EQ(draw(0.1f, 4), averagedWith);
    frame.heatMap = HeatMap::LightsPerPixel;
    const auto map = draw(0.1f);
    EXPECT_STREQ(skipped(), "a heat map is shown");
    EXPECT_EQ(draw(0), map);
    frame.heatMap = HeatMap::None;
    renderer.resize({33, 20});
    const auto resized = draw(0.1f);
    EXPECT_EQ(resized.size(), 33u * 20 * 3);
    EXPECT_EQ(draw(0.1f), resized);
}
