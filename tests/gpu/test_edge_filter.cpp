// SPDX-License-Identifier: Apache-2.0
// Tests FrameOptions::edgeFilter on a white triangle without light, and on the hall.
#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <numbers>

#include "generate/generators.h"
#include "harness/gpu_fixture.h"
#include "measure/frame/frames.h"
#include "render/camera.h"
#include "render/readback.h"

using namespace candelabra;
using namespace candelabra::app;

namespace
{

class EdgeFilter : public test::GpuTest
{
protected:
    using Pixels = std::vector<uint8_t>; // RGB, rows from the top

    // A surface with the display's white below y = 0.
    static Scene halfPlane()
    {
        Scene scene;
        scene.meshes.push_back({{{.position = {1000, 0, 0}, .normal = {0, 0, 1}},
                                 {.position = {-1000, 0, 0}, .normal = {0, 0, 1}},
                                 {.position = {0, -1000, 0}, .normal = {0, 0, 1}}},
                                {2, 0, 1}});
        scene.materials.push_back(
            {.baseColor = glm::vec3(0), .emission = glm::vec3(1), .unlit = true});
        scene.instances.push_back({});
        return scene;
    }
    // Shows the edge turned by an angle about a point near the middle of the picture.
    static FrameOptions halfPlaneFrame(double degrees)
    {
        const double angle = degrees * std::numbers::pi / 180;
        FrameOptions frame{.camera = {.position = {0, 0.01, 5},
                                      .up = {std::sin(angle), std::cos(angle), 0},
                                      .orthographic = true,
                                      .orthographicHeight = 10,
                                      .farPlane = 100}};
        cndDefaultExposureSettings(&frame.exposure);
        frame.exposure.manual = VK_TRUE;
        frame.exposure.manualEv100 = -2;
        frame.exposure.toneMap = CND_TONEMAP_NONE;
        frame.exposure.dither = VK_FALSE;
        return frame;
    }
    static FrameOptions hallFrame(const Scene& scene)
    {
        FrameOptions frame{.camera = selectCamera(scene, "")};
        cndDefaultExposureSettings(&frame.exposure);
        return frame;
    }
    static RendererOptions optionsOf(PixelSize size)
    {
        return {.size = size, .specularMethods = 1u << FrameOptions{}.specular};
    }
    Pixels display(Renderer& renderer, const FrameOptions& frame, uint32_t samples = 1) const
    {
        renderFrames(context(), renderer, frame, {.warmUp = 0, .samples = samples}, false, [] {});
        return readDisplay(context(), renderer);
    }
    Pixels filtered(Renderer& renderer, FrameOptions frame) const
    {
        frame.edgeFilter = true;
        return display(renderer, frame);
    }
};

double meanSquare(const std::vector<uint8_t>& a, const std::vector<uint8_t>& b)
{
    double sum = 0;
    for (size_t i = 0; i < a.size(); ++i)
        sum += std::pow((int(a[i]) - int(b[i])) / 255.0, 2);
    return sum / double(a.size());
}

} // namespace

// Measured: the error of one sample per pixel is divided by 3.0 (45 degrees) to 14.
TEST_F(EdgeFilter, BringsSlantedEdgesCloserToTheMeanOfManySamples)
{
    const Scene scene = halfPlane();
    Renderer renderer(context(), scene, optionsOf({128, 128}));
    for (const double degrees : {3.0, 14.0, 30.0, 45.0, 76.0, 85.0, 150.0}) {
        const FrameOptions frame = halfPlaneFrame(degrees);
        const Pixels truth = display(renderer, frame, 64);
        const double before = meanSquare(display(renderer, frame), truth);
        const double after = meanSquare(filtered(renderer, frame), truth);
        std::cout << degrees << " degrees: " << before << " -> " << after << ", divided by "
                  << before / after << "\n";
        EXPECT_GT(before, 0.001) << degrees;
        EXPECT_LT(after * (degrees == 45 ? 2.5 : 6), before) << degrees;
    }
}

// With dither, which changes pixels by up to a step, so that areas are not quite flat.
TEST_F(EdgeFilter, KeepsTheBitsOfAreasWithoutEdges)
{
    constexpr PixelSize size{96, 64};
    const Scene scene = generateHall({.lights = 50});
    const FrameOptions frame = hallFrame(scene);
    Renderer renderer(context(), scene, optionsOf(size));
    const Pixels before = display(renderer, frame), after = filtered(renderer, frame);
    size_t flat = 0, changed = 0;
    for (uint32_t y = 0; y < size.height; ++y)
        for (uint32_t x = 0; x < size.width; ++x) {
            const auto at = [&](uint32_t px, uint32_t py, size_t channel) {
                px = std::min(px, size.width - 1); // -1 is the largest number
                py = std::min(py, size.height - 1);
                return int(before[3 * (py * size.width + px) + channel]);
            };
            bool isFlat = true, same = true;
            for (size_t c = 0; c < 3; ++c) {
                const std::array around{at(x, y, c), at(x ? x - 1 : 0, y, c), at(x + 1, y, c),
                                        at(x, y ? y - 1 : 0, c), at(x, y + 1, c)};
                const auto [least, most] = std::ranges::minmax(around);
                isFlat &= most - least <= 10;
                same &= after[3 * (y * size.width + x) + c] == at(x, y, c);
            }
            flat += isFlat;
            changed += !same;
            EXPECT_TRUE(same || !isFlat) << x << "," << y;
        }
    EXPECT_GT(flat, size.width * size.height / 10);
    EXPECT_GT(changed, size.width * size.height / 8);
}

TEST_F(EdgeFilter, GivesTheSameBitsTwiceAtAnySize)
{
    const Scene scene = halfPlane();
    const FrameOptions frame = halfPlaneFrame(20);
    Renderer first(context(), scene, optionsOf({1, 1})),
        second(context(), scene, optionsOf({1, 1}));
    for (const PixelSize size :
         {PixelSize{1, 1}, {1, 40}, {40, 1}, {2, 3}, {65, 9}, {63, 17}, {161, 91}}) {
        first.resize(size);
        second.resize(size);
        const Pixels one = filtered(first, frame);
        display(second, frame); // a frame without the filter must leave no trace
        EXPECT_EQ(one, filtered(second, frame)) << size.width << "x" << size.height;
        EXPECT_EQ(one, filtered(second, frame)) << size.width << "x" << size.height;
    }
}

// Seen with a camera that is turned by 180 degrees, the edge is the same, and the surface is on its
// other side. So the shares of the surface in a pixel add up to 1. They would not if the filter
// preferred one side.
TEST_F(EdgeFilter, PrefersNoSideOfAnEdge)
{
    const auto light = [](uint8_t encoded) {
        const double c = encoded / 255.0;
        return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
    };
    const Scene scene = halfPlane();
    Renderer renderer(context(), scene, optionsOf({96, 96}));
    for (const double degrees : {5.0, 20.0, 70.0}) {
        FrameOptions frame = halfPlaneFrame(degrees);
        frame.camera.position.y = 0;
        const Pixels one = filtered(renderer, frame);
        frame.camera.up = -frame.camera.up;
        const Pixels other = filtered(renderer, frame);
        for (size_t i = 0; i < one.size(); ++i)
            ASSERT_NEAR(light(one[i]) + light(other[i]), 1, 0.01) << degrees << ", value " << i;
    }
}

TEST_F(EdgeFilter, LeavesSamplesAndHeatMapsAndRadianceAlone)
{
    const Scene scene = generateHall({.lights = 50});
    FrameOptions frame = hallFrame(scene);
    Renderer renderer(context(), scene, optionsOf({64, 48}));
    const auto skipped = [&] {
        const std::vector<CndPassPlan> plan = renderer.stats(0).plan;
        const auto at = std::ranges::find(plan, std::string("edge_filter"), &CndPassPlan::name);
        return at == plan.end() ? "no such pass" : at->skipped ? at->skipped : "";
    };
    const auto hasTime = [&] {
        return std::ranges::any_of(renderer.stats(0).passes, [](const PassTime& pass) {
            return pass.name == "edge_filter" && pass.ms > 0;
        });
    };
    display(renderer, frame);
    const Image radiance = readRadiance(context(), renderer);
    EXPECT_STREQ(skipped(), "it is off");
    EXPECT_FALSE(hasTime());
    EXPECT_NE(filtered(renderer, frame), display(renderer, frame));
    filtered(renderer, frame);
    EXPECT_STREQ(skipped(), "");
    EXPECT_TRUE(hasTime());
    EXPECT_EQ(readRadiance(context(), renderer).pixels, radiance.pixels);
    const Pixels averaged = display(renderer, frame, 2);
    frame.edgeFilter = true;
    EXPECT_EQ(display(renderer, frame, 2), averaged);
    EXPECT_STREQ(skipped(), "samples are averaged");
    frame.heatMap = HeatMap::LightsPerPixel;
    const Pixels map = display(renderer, frame);
    EXPECT_STREQ(skipped(), "a heat map is shown");
    frame.edgeFilter = false;
    EXPECT_EQ(display(renderer, frame), map);
}
