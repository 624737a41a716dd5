// SPDX-License-Identifier: Apache-2.0
// Detectably wrong cameras are refused, each with its sentence, and valid ones are accepted.
#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "candelabra/candelabra.hpp"
#include "mock/mock_vulkan.h"

namespace candelabra::test
{
namespace
{

using Matrix = std::array<float, 16>;

Matrix transposed(const Matrix& m)
{
    Matrix out{};
    for (int c = 0; c < 4; ++c)
        for (int r = 0; r < 4; ++r)
            out[4 * c + r] = m[4 * r + c];
    return out;
}

// Projections by the sign of the view direction's z and the depths of the near and far planes.

Matrix perspective(float z, float nearPlane, float farPlane, float nearDepth, float farDepth)
{
    const float slope = (nearDepth - farDepth) / (1 / nearPlane - 1 / farPlane);
    return {1.5f, 0, 0, 0,     0, -2, 0, 0, 0.1f, 0, z * (farDepth - slope / farPlane),
            z,    0, 0, slope, 0};
}

Matrix infinite(float z, float nearPlane, bool reversed)
{
    return {1.5f,
            0,
            0,
            0,
            0,
            -2,
            0,
            0,
            0,
            0,
            reversed ? 0 : z,
            z,
            0,
            0,
            reversed ? nearPlane : -nearPlane,
            0};
}

Matrix orthographic(float nearPlane, float farPlane, bool reversed)
{
    const float scale = (reversed ? 1 : -1) / (farPlane - nearPlane);
    return {0.2f,  0, 0, 0, 0,
            -0.3f, 0, 0, 0, 0,
            scale, 0, 0, 0, reversed ? farPlane * scale : nearPlane * scale,
            1};
}

// Returns the message that refuses a clipFromView with this element.
std::string shears(int element)
{
    return "CndCamera: clipFromView may only scale and shift x and y (element " +
           std::to_string(element) +
           " must be 0); it is the projection alone, not its product with the view matrix";
}

constexpr std::array<double, 16> someView{0, 0, -1, 0, 0, 1, 0, 0, 1, 0, 0, 0, 5, 6, 7, 1};

// Records the frames of both modules with a camera, and returns the sentence, in which the name of
// the frame's type is replaced by "Frame". They must agree.
class Cameras : public ::testing::Test
{
protected:
    void SetUp() override
    {
        auto lighting = Lighting::create(vulkan_.desc(), {.framesInFlight = 1});
        auto environment = Environment::create(vulkan_.desc(), {.framesInFlight = 1});
        ASSERT_TRUE(lighting && environment);
        lighting_ = std::move(lighting.value());
        environment_ = std::move(environment.value());
        auto view = lighting_.createView({.maxWidth = 8, .maxHeight = 8});
        ASSERT_TRUE(view);
        view_ = std::move(view.value());
        ASSERT_TRUE(environment_.recordMap(
            MockVulkan::commandBuffer(),
            {.width = 4, .height = 2, .equirectangular = MockVulkan::imageView()}));
        vulkan_.finish(vulkan_.submit());
    }

    std::string sentence(const Matrix& clipFromView, float clearDepth,
                         const std::array<double, 16>& viewFromWorld = someView)
    {
        CndCamera camera{};
        std::copy(clipFromView.begin(), clipFromView.end(), camera.clipFromView);
        std::copy(viewFromWorld.begin(), viewFromWorld.end(), camera.viewFromWorld);
        auto lit = frame<CndLightingFrame>(camera, clearDepth);
        lit.specularMethod = CND_SPECULAR_CONIC;
        auto surrounded = frame<CndEnvironmentFrame>(camera, clearDepth);
        for (const int i : {0, 4, 8})
            surrounded.worldFromEnvironment[i] = 1;
        const VkCommandBuffer cmd = MockVulkan::commandBuffer();
        const std::string first = neutral(view_.record(cmd, lit), "CndLightingFrame");
        const std::string second =
            neutral(environment_.record(cmd, surrounded), "CndEnvironmentFrame");
        vulkan_.finish(vulkan_.submit());
        EXPECT_EQ(first, second);
        return first;
    }

private:
    template <typename Frame>
    static Frame frame(const CndCamera& camera, float clearDepth)
    {
        const VkImageView any = MockVulkan::imageView();
        return {.width = 8,
                .height = 8,
                .camera = camera,
                .clearDepth = clearDepth,
                .normalRoughness = any,
                .albedo = any,
                .specular = any,
                .depth = any,
                .radiance = any};
    }
    static std::string neutral(const Result<void>& result, const std::string& type)
    {
        std::string text = result.error().message;
        const size_t at = text.find(type);
        return at == std::string::npos ? text : text.replace(at, type.size(), "Frame");
    }

    MockVulkan vulkan_;
    Lighting lighting_;
    LightingView view_;
    Environment environment_;
};

TEST_F(Cameras, RightOnesAreTaken)
{
    for (const float z : {-1.0f, 1.0f}) {
        EXPECT_EQ(sentence(infinite(z, 0.1f, true), 0), "");
        EXPECT_EQ(sentence(infinite(z, 0.1f, false), 1), "");
        EXPECT_EQ(sentence(infinite(z, 1, true), 0), ""); // elements 11 and 14 are equal
        for (const float nearPlane : {0.01f, 0.5f, 1.0f, 30.0f}) {
            EXPECT_EQ(sentence(perspective(z, nearPlane, 1000, 1, 0), 0), "") << nearPlane;
            EXPECT_EQ(sentence(perspective(z, nearPlane, 1000, 0, 1), 1), "") << nearPlane;
            // A viewport from 0.25 to 0.75.
            EXPECT_EQ(sentence(perspective(z, nearPlane, 1000, 0.75f, 0.25f), 0), "");
            EXPECT_EQ(sentence(perspective(z, nearPlane, 1000, 0.25f, 0.75f), 1), "");
        }
    }
    for (const float clearDepth : {0.0f, 1.0f}) // a parallel projection may look both ways
        EXPECT_EQ(sentence(orthographic(0.1f, 50, clearDepth == 0), clearDepth), "");
    EXPECT_EQ(
        sentence(infinite(-1, 0.1f, true), 0, {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}),
        "");
}

TEST_F(Cameras, ATransposedViewIsNoticed)
{
    const std::string said = "CndCamera: viewFromWorld is transposed: its columns must follow one "
                             "another, with the translation in elements 12, 13 and 14";
    std::array<double, 16> view{};
    for (int c = 0; c < 4; ++c)
        for (int r = 0; r < 4; ++r)
            view[4 * c + r] = someView[4 * r + c];
    EXPECT_EQ(sentence(infinite(-1, 0.1f, true), 0, view), said);
    std::array<double, 16> product = someView; // such as a product with a projection
    product[11] = -1;
    product[15] = 0;
    const std::string lastRow = "CndCamera: the last row of viewFromWorld (elements 3, 7, 11 and "
                                "15) must be 0, 0, 0, 1";
    EXPECT_EQ(sentence(infinite(-1, 0.1f, true), 0, product), lastRow);
    std::array<double, 16> scaled = someView;
    scaled[15] = 2;
    EXPECT_EQ(sentence(infinite(-1, 0.1f, true), 0, scaled), lastRow);
}

TEST_F(Cameras, ATransposedProjectionIsNoticed)
{
    const std::string said = "CndCamera: clipFromView is transposed: its columns must follow one "
                             "another, with the 1 or -1 of the last row in element 11";
    for (const float z : {-1.0f, 1.0f}) {
        EXPECT_EQ(sentence(transposed(infinite(z, 0.1f, true)), 0), said);
        EXPECT_EQ(sentence(transposed(infinite(z, 0.1f, false)), 1), said);
    }
    Matrix centred = perspective(-1, 0.1f, 100, 0, 1);
    centred[8] = 0;
    EXPECT_EQ(sentence(transposed(centred), 1), said);
    EXPECT_EQ(sentence(transposed(perspective(-1, 0.1f, 100, 0, 1)), 1), // off centre
              shears(2));
}

TEST_F(Cameras, AProductOfProjectionAndViewIsNoticed)
{
    Matrix product = infinite(-1, 0.1f, true); // times a view that looks along +y, z up
    product[9] = product[5];
    product[7] = 1;
    product[5] = product[11] = 0;
    EXPECT_EQ(sentence(product, 0), shears(7));
}

TEST_F(Cameras, TheClearedDepthIsThatOfTheFarEnd)
{
    const std::string falls = "Frame: clearDepth is 1, but camera.clipFromView makes depth fall "
                              "with distance (reversed depth): clear depth to 0, and set "
                              "clearDepth to 0";
    const std::string grows = "Frame: clearDepth is 0, but camera.clipFromView makes depth grow "
                              "with distance: clear depth to 1, and set clearDepth to 1";
    for (const float z : {-1.0f, 1.0f}) {
        EXPECT_EQ(sentence(infinite(z, 0.1f, true), 1), falls);
        EXPECT_EQ(sentence(perspective(z, 0.1f, 100, 1, 0), 1), falls);
        EXPECT_EQ(sentence(infinite(z, 0.1f, false), 0), grows);
        EXPECT_EQ(sentence(perspective(z, 0.1f, 100, 0, 1), 0), grows);
    }
}

TEST_F(Cameras, WrongSignsAreNoticed)
{
    const std::string said = "CndCamera: clipFromView gives nothing in front of the eye a depth of "
                             "0..1: the signs of elements 10, 11 and 14 do not fit together";
    for (const float clearDepth : {0.0f, 1.0f}) {
        Matrix negative = infinite(-1, 0.1f, true);
        negative[14] = -negative[14];
        EXPECT_EQ(sentence(negative, clearDepth), said);
        Matrix other = perspective(-1, 0.1f, 100, 0, 1);
        other[10] = -other[10];
        EXPECT_EQ(sentence(other, clearDepth), said);
        Matrix both = perspective(-1, 0.1f, 100, 0, 1);
        both[14] = -both[14];
        EXPECT_EQ(sentence(both, clearDepth), said);
    }
}

} // namespace
} // namespace candelabra::test
