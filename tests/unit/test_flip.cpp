// SPDX-License-Identifier: Apache-2.0
// Tests FLIP and the error measures of images on images whose differences are known.
#include <cmath>

#include <gtest/gtest.h>

#include "measure/accuracy/image_error.h"

namespace candelabra::app
{
namespace
{

DisplayImage plain(const glm::vec3& colour)
{
    return {40, 30, std::vector<glm::vec3>(1200, colour)};
}

} // namespace

TEST(Flip, EqualImagesDoNotDiffer)
{
    DisplayImage image = plain({0.3f, 0.6f, 0.1f});
    for (size_t i = 0; i < image.pixels.size(); i += 7)
        image.pixels[i] = {0.9f, 0.2f, 0.5f};
    for (const float x : flipMap(image, image))
        EXPECT_EQ(x, 0);
}

// Without features the value is the compressed HyAB distance alone. Black to white: 100^0.7 =
// 25.12. The largest distance, green to blue, is 41.28, and the knee is at 40% of it: 0.95 + 0.05
// (25.12 - 16.51) / 24.77.
TEST(Flip, BlackAgainstWhiteIsWithinTheLastFivePercent)
{
    const auto map = flipMap(plain(glm::vec3(0)), plain(glm::vec3(1)));
    std::cout << "black against white: " << map[0] << "\n";
    for (const float x : map) {
        EXPECT_NEAR(x, 0.9674f, 1e-3f);
    }
}

TEST(Flip, GreenAgainstBlueIsOneAndOrderDoesNotMatter)
{
    const DisplayImage green = plain({0, 1, 0}), blue = plain({0, 0, 1});
    EXPECT_NEAR(meanOf(flipMap(green, blue)), 1, 1e-3);
    EXPECT_NEAR(meanOf(flipMap(blue, green)), 1, 1e-3);
}

// From afar, a line one pixel wide is blurred away in colour, but its edge remains a feature.
TEST(Flip, LinesDifferMoreThanTheirMeanColour)
{
    DisplayImage lines = plain(glm::vec3(0.5f));
    for (uint32_t y = 0; y < lines.height; ++y)
        lines.pixels[y * lines.width + 20] = glm::vec3(1);
    const auto map = flipMap(plain(glm::vec3(0.5f)), lines);
    const float atLine = map[15 * 40 + 20], far = map[15 * 40 + 2];
    std::cout << "at the line " << atLine << ", far from it " << far << "\n";
    EXPECT_GT(atLine, 0.2f);
    EXPECT_LT(far, 0.05f);
}

TEST(ImageDifferences, OfAKnownFactor)
{
    Image truth{10, 10, 3, std::vector<float>(300, 2.0f)};
    truth.pixels[3] = 0;
    Image value = truth;
    for (float& x : value.pixels)
        x *= 1.1f;
    const ImageDifference d = imageDifference(value, truth);
    EXPECT_NEAR(d.litMeanRel, 0.1, 1e-6);
    EXPECT_NEAR(d.litRelMse, 0.01, 1e-6);
    EXPECT_NEAR(d.litMaxRel, 0.1, 1e-6);
    EXPECT_NEAR(d.maxOverPeak, 0.1, 1e-6);
    EXPECT_NEAR(d.energy, 0.1, 1e-6);
    EXPECT_NEAR(d.relL1, 0.1, 1e-6);
    const std::vector<double> errors = relativeErrors(value, truth);
    EXPECT_NEAR(errors[0], 0.1 / std::sqrt(1.01), 1e-3);
    EXPECT_EQ(errors[3], 0);
    // 0.04 / (4 + 0.01 mean^2) with a mean of nearly 2; the black sample has no error.
    EXPECT_NEAR(d.relMse, 0.01 / 1.01 * 299 / 300, 1e-5);

    value.pixels[7] = NAN;
    const ImageDifference bad = imageDifference(value, truth);
    EXPECT_EQ(bad.invalid, 1u);
    EXPECT_EQ(bad.worst[0].x, 2u);
    EXPECT_EQ(bad.worst[0].value, 0);
}

} // namespace candelabra::app
