// SPDX-License-Identifier: Apache-2.0
// Tests whole frames of the program's renderer: clustered against brute force, repeatability,
// resizing, moving lights. The fixture requires that validation reports nothing.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <iostream>
#include <limits>
#include <numeric>
#include <tuple>

#include "generate/generators.h"
#include "harness/gpu_fixture.h"
#include "measure/frame/brute_check.h"
#include "measure/frame/frames.h"
#include "render/camera.h"
#include "render/heat_map_legend.h"
#include "render/readback.h"
#include "json/save.h"

using namespace candelabra;
using namespace candelabra::app;

namespace
{

class RendererTest : public test::GpuTest
{
protected:
    static Scene hall(uint32_t lights, bool moving = false)
    {
        return generateHall({.lights = lights, .moving = moving});
    }
    // The first instances of the field, under the open sky: few enough for the smallest texel
    // buffer that Vulkan allows.
    static Scene openAir(uint32_t lights)
    {
        Scene scene = generateField({.lights = lights});
        scene.instances.resize(16'000);
        return scene;
    }
    static FrameOptions frameOf(const Scene& scene)
    {
        FrameOptions frame{.camera = selectCamera(scene, ""), .lightsVisible = false};
        cndDefaultExposureSettings(&frame.exposure);
        return frame;
    }
    // Asks for the pipelines of one specular method alone: without a GPU, those of all methods take
    // much longer than the frames.
    static RendererOptions optionsOf(PixelSize size)
    {
        return {.size = size, .specularMethods = 1u << FrameOptions{}.specular};
    }
    FrameStats draw(Renderer& renderer, const FrameOptions& frame) const
    {
        context().submitAndWait([&](VkCommandBuffer cmd) { renderer.record(cmd, 0, frame); });
        return renderer.stats(0);
    }
    Image radiance(Renderer& renderer, const FrameOptions& frame) const
    {
        draw(renderer, frame);
        return readRadiance(context(), renderer);
    }
};

// Returns the index of the first value whose bits differ, or -1.
long firstDifference(const Image& a, const Image& b)
{
    if (a.pixels.size() != b.pixels.size())
        return 0;
    for (size_t i = 0; i < a.pixels.size(); ++i)
        if (std::memcmp(&a.pixels[i], &b.pixels[i], sizeof(float)) != 0)
            return long(i);
    return -1;
}

} // namespace

TEST_F(RendererTest, ClusteredIsBruteForceAtOddSizes)
{
    const Scene scene = hall(300);
    const FrameOptions frame = frameOf(scene);
    for (const PixelSize size : {PixelSize{1, 1}, {17, 3}, {161, 91}}) {
        Renderer renderer(context(), scene, optionsOf(size));
        const Image clustered = radiance(renderer, frame);
        const BruteCheck check =
            compareWithBruteForce(context(), renderer, frame, clustered,
                                  checkRects(size, scene.lights.size(), CheckExtent::Full),
                                  scene.lights.size(), [](double) {});
        EXPECT_TRUE(check.allPixels) << size.width << "x" << size.height;
        EXPECT_GT(check.maxRadiance, 0) << size.width << "x" << size.height;
        EXPECT_LE(check.relative(), BruteCheck::bound) << size.width << "x" << size.height;
    }
}

// A frame that lacks room for lists or shadows makes the next one have more.
TEST_F(RendererTest, FramesGetTheRoomThatTheyLack)
{
    const Scene scene = generateScene("rooms", {.lights = 400});
    FrameOptions frame = frameOf(scene);
    frame.shadows = 32;
    RendererOptions options = optionsOf({96, 54});
    options.shadows = 32;
    Renderer roomy(context(), scene, options);
    const Image expected = radiance(roomy, frame);
    EXPECT_TRUE(roomy.fits(0));
    options.listBudget = 4096;
    options.shadowBudget = 4096;
    Renderer grows(context(), scene, options);
    const Image first = radiance(grows, frame);
    EXPECT_GT(grows.lightingStats(0).unlistedClusters, 0u);
    int frames = 1;
    Image last = first;
    while (frames < 6 && !grows.fits(0)) {
        last = radiance(grows, frame);
        ++frames;
    }
    EXPECT_GT(frames, 1);
    EXPECT_LE(frames, 5);
    const CndLightingStats fitting = grows.lightingStats(0), wanted = roomy.lightingStats(0);
    EXPECT_EQ(fitting.missingListBytes, 0u);
    EXPECT_EQ(fitting.missingShadowSlots, 0u);
    EXPECT_EQ(fitting.unlistedClusters, 0u);
    EXPECT_EQ(fitting.shadowSlots, wanted.shadowSlots);
    EXPECT_EQ(fitting.wonProofs, wanted.wonProofs);
    EXPECT_EQ(firstDifference(last, expected), -1);
    const float largest = *std::max_element(expected.pixels.begin(), expected.pixels.end());
    for (size_t i = 0; i < first.pixels.size(); ++i)
        ASSERT_NEAR(first.pixels[i], expected.pixels[i], 1e-5f * largest) << i;
}

// The comparison itself must be able to fail.
TEST_F(RendererTest, BruteForceCheckNoticesOneWrongPixel)
{
    const Scene scene = hall(100);
    const FrameOptions frame = frameOf(scene);
    const PixelSize size{64, 40};
    Renderer renderer(context(), scene, optionsOf(size));
    const Image clustered = radiance(renderer, frame);
    const auto check = [&](const Image& image) {
        return compareWithBruteForce(context(), renderer, frame, image,
                                     checkRects(size, 100, CheckExtent::Full), 100, [](double) {});
    };
    ASSERT_TRUE(check(clustered).passed());
    Image changed = clustered;
    const double largest = check(clustered).maxRadiance;
    changed.pixels[3 * (64 * 17 + 5)] += float(2e-6 * largest);
    EXPECT_FALSE(check(changed).passed());
    changed = clustered;
    changed.pixels.back() = std::numeric_limits<float>::quiet_NaN();
    EXPECT_FALSE(check(changed).passed());
}

TEST_F(RendererTest, TwoRenderersGiveTheSameBits)
{
    const Scene scene = hall(400, true);
    FrameOptions frame = frameOf(scene);
    frame.time = 1.25;
    frame.lightsVisible = true;
    Renderer first(context(), scene, optionsOf({160, 90}));
    Renderer second(context(), scene, optionsOf({160, 90}));
    draw(second, frameOf(scene)); // an earlier frame at another time must leave no trace
    EXPECT_EQ(firstDifference(radiance(first, frame), radiance(second, frame)), -1);
    EXPECT_EQ(readDisplay(context(), first), readDisplay(context(), second));
}

// A renderer that begins with few pipelines, no lights and other materials, as the viewer makes it
// while another one draws, draws the same bits as one that was made with all it needs.
TEST_F(RendererTest, WhatIsPreparedLaterHasTheSameBits)
{
    Scene scene = hall(60);
    scene.lights.push_back({.type = CND_LIGHT_POINT,
                            .position = {0, 2, 0},
                            .emission = {300, 200, 100},
                            .influenceRadius = 6});
    std::vector<Material> rough = scene.materials;
    overrideMaterials(rough, {true, 0.7f, 0});
    FrameOptions frame = frameOf(scene);
    RendererOptions few = optionsOf({160, 90});
    few.shading = shadingOf(frame);
    few.materials = &rough;
    few.lightTypes = 1u << CND_LIGHT_SPHERE;
    Renderer later(context(), scene, few);
    EXPECT_TRUE(later.canDraw(frame));
    EXPECT_FALSE(later.canLightBy(lightTypesOf(scene)));
    later.prepareToLightBy(lightTypesOf(scene));
    EXPECT_TRUE(later.canLightBy(lightTypesOf(scene)));
    later.lightsChanged();
    FrameOptions counted = frame;
    counted.specular = CND_SPECULAR_KARIS;
    counted.heatMap = HeatMap::LightsPerPixel;
    EXPECT_FALSE(later.canDraw(counted));
    later.prepareToDraw(counted);
    EXPECT_TRUE(later.canDraw(counted));

    scene.materials = rough;
    Renderer whole(context(), scene,
                   {.size = {160, 90},
                    .specularMethods = 1u << CND_SPECULAR_CONIC | 1u << CND_SPECULAR_KARIS,
                    .shading = shadingOf(counted)});
    EXPECT_EQ(firstDifference(radiance(later, frame), radiance(whole, frame)), -1);
    EXPECT_EQ(firstDifference(radiance(later, counted), radiance(whole, counted)), -1);
    EXPECT_EQ(readDisplay(context(), later), readDisplay(context(), whole));
}

// The upper edge of a rectangle runs through a row of pixels, its right edge through a column, so
// that each sample of a pixel shows the rectangle or nothing. The mean of the radiance is the
// rectangle's share of the pixel's filter. The mean of the display is that share of the display's
// white, although the rectangle is more than a hundred times brighter than white.
TEST_F(RendererTest, SamplesAreTheMeanOfWhatTheyShow)
{
    constexpr double luminance = 100, height = 8; // the view is 8 m high, a pixel 1 m
    Scene scene;
    CndLight light{.type = CND_LIGHT_RECTANGLE,
                   .emission = {float(luminance), float(luminance), float(luminance)},
                   .influenceRadius = 1000,
                   .axisU = {100, 0, 0},
                   .axisV = {0, 100, 0},
                   .twoSided = 1};
    light.position[0] = 0.4f - 100;  // its right edge is 0.4 pixels to the right of the middle
    light.position[1] = 0.75f - 100; // its upper edge is 3/4 of a pixel above the middle
    scene.lights = {light};
    FrameOptions frame{.camera = {.position = {0, 0, 5},
                                  .orthographic = true,
                                  .orthographicHeight = height,
                                  .farPlane = 100},
                       .lightsVisible = true};
    cndDefaultExposureSettings(&frame.exposure);
    frame.exposure.manual = VK_TRUE;
    frame.exposure.manualEv100 = 0; // white is 0.125 / 0.18 = 0.69 cd/m^2
    frame.exposure.toneMap = CND_TONEMAP_NONE;
    Renderer renderer(context(), scene, optionsOf({16, 8}));
    constexpr uint32_t samples = 64;
    renderFrames(context(), renderer, frame, {.samples = samples}, false, [] {});
    const Image radiance = readRadiance(context(), renderer);
    const std::vector<uint8_t> display = readDisplay(context(), renderer);
    // The share, along one axis, of the filter of a pixel whose centre is `d` pixels inside an
    // edge.
    const auto shareInside = [](double d) {
        d = std::clamp(d, -1.5, 1.5);
        return d < -0.5  ? std::pow(1.5 + d, 3) / 6
               : d < 0.5 ? 0.5 + 0.75 * d - d * d * d / 3
                         : 1 - std::pow(1.5 - d, 3) / 6;
    };
    for (uint32_t y = 0; y < 8; ++y)
        for (uint32_t x = 0; x < 16; ++x) {
            const double share = shareInside(8.4 - (x + 0.5)) * shareInside(y + 0.5 - 3.25);
            const double encoded =
                share <= 0.0031308 ? 12.92 * share : 1.055 * std::pow(share, 1 / 2.4) - 0.055;
            EXPECT_NEAR(radiance.pixels[3 * (y * 16 + x)], share * luminance, luminance / 64)
                << x << "," << y;
            EXPECT_NEAR(display[3 * (y * 16 + x)], 255 * encoded, 5) << x << "," << y;
        }
}

// Random samples of highlights are other ones in each sample of a frame, so their noise averages
// out. The largest part of it that the filter alone would leave is a half.
TEST_F(RendererTest, SamplesOfAFrameHaveNoiseOfTheirOwn)
{
    Scene scene;
    scene.meshes.push_back({{{.position = {-100, -100, 0}, .normal = {0, 0, 1}},
                             {.position = {100, -100, 0}, .normal = {0, 0, 1}},
                             {.position = {0, 200, 0}, .normal = {0, 0, 1}}},
                            {0, 1, 2}});
    scene.materials.push_back({.metalness = 1, .perceptualRoughness = 0.7f});
    scene.instances.push_back({});
    CndLight light{.type = CND_LIGHT_SPHERE,
                   .radius = 3,
                   .emission = {100, 100, 100},
                   .influenceRadius = 1000};
    light.position[2] = 5;
    scene.lights = {light};
    FrameOptions frame{.camera = {.position = {0, 0, 9},
                                  .orthographic = true,
                                  .orthographicHeight = 4,
                                  .farPlane = 100},
                       .lightsVisible = false};
    cndDefaultExposureSettings(&frame.exposure);
    Renderer renderer(context(), scene,
                      {.size = {32, 16},
                       .specularMethods = 1u << CND_SPECULAR_CONIC | 1u << CND_SPECULAR_SAMPLED});
    const auto draw = [&](CndSpecularMethod specular, uint32_t samples) {
        frame.specular = specular;
        frame.sampleCount = 1;
        renderFrames(context(), renderer, frame, {.samples = samples}, false, [] {});
        return readRadiance(context(), renderer);
    };
    const Image exact = draw(CND_SPECULAR_CONIC, 1);
    const auto noise = [&](const Image& image) {
        double sum = 0;
        for (size_t i = 0; i < image.pixels.size(); ++i)
            sum += std::pow(double(image.pixels[i]) / double(exact.pixels[i]) - 1, 2);
        return std::sqrt(sum / double(image.pixels.size()));
    };
    const double one = noise(draw(CND_SPECULAR_SAMPLED, 1));
    EXPECT_GT(one, 0.05);
    EXPECT_LT(noise(draw(CND_SPECULAR_SAMPLED, 64)), 0.2 * one);
}

// In each sample a surface covers other pixels, so every pixel is covered by its share of samples.
TEST_F(RendererTest, SamplesAverageCoverage)
{
    constexpr float luminance = 100, coverage = 0.25f;
    Scene scene;
    scene.meshes.push_back({{{.position = {-100, -100, 0}, .normal = {0, 0, 1}},
                             {.position = {100, -100, 0}, .normal = {0, 0, 1}},
                             {.position = {0, 200, 0}, .normal = {0, 0, 1}}},
                            {0, 1, 2}});
    scene.materials.push_back({.baseColor = glm::vec3(0),
                               .alpha = coverage,
                               .emission = glm::vec3(luminance),
                               .alphaMode = AlphaMode::Blend,
                               .unlit = true});
    scene.instances.push_back({});
    FrameOptions frame{
        .camera = {
            .position = {0, 0, 5}, .orthographic = true, .orthographicHeight = 8, .farPlane = 100}};
    cndDefaultExposureSettings(&frame.exposure);
    Renderer renderer(context(), scene, optionsOf({16, 8}));
    const Image one = radiance(renderer, frame);
    EXPECT_EQ(std::count(one.pixels.begin(), one.pixels.end(), 0.0f) +
                  std::count(one.pixels.begin(), one.pixels.end(), luminance),
              3 * 16 * 8);
    renderFrames(context(), renderer, frame, {.samples = 64}, false, [] {});
    for (const float value : readRadiance(context(), renderer).pixels)
        EXPECT_NEAR(value, coverage * luminance, 0.05f * luminance);
}

// Neither animation nor adaptation may start before the first measured frame.
TEST_F(RendererTest, WarmUpFramesLeaveNoTrace)
{
    const Scene scene = hall(200, true);
    const FrameOptions frame = frameOf(scene);
    const auto after = [&](uint32_t warmUp) {
        Renderer renderer(context(), scene, optionsOf({160, 90}));
        const MeasuredFrames frames = renderFrames(context(), renderer, frame,
                                                   {.warmUp = warmUp, .measured = 3}, true, [] {});
        return std::tuple(frames.last.exposure.adaptedEv100, readRadiance(context(), renderer),
                          readDisplay(context(), renderer));
    };
    const auto [ev, radiance, display] = after(0);
    const auto [warmEv, warmRadiance, warmDisplay] = after(2);
    EXPECT_EQ(ev, warmEv);
    EXPECT_EQ(firstDifference(radiance, warmRadiance), -1);
    EXPECT_EQ(display, warmDisplay);
}

TEST_F(RendererTest, MovingLightsMove)
{
    const Scene scene = hall(200, true);
    FrameOptions frame = frameOf(scene);
    Renderer renderer(context(), scene, optionsOf({160, 90}));
    const Image before = radiance(renderer, frame);
    frame.time = 0.5;
    EXPECT_NE(firstDifference(before, radiance(renderer, frame)), -1);
    frame.time = 0;
    EXPECT_EQ(firstDifference(before, radiance(renderer, frame)), -1);
}

TEST_F(RendererTest, ResizeGivesTheFrameOfThatSizeAndKeepsExposure)
{
    const Scene scene = hall(200);
    FrameOptions frame = frameOf(scene);
    Renderer renderer(context(), scene, optionsOf({200, 120}));
    const float converged = draw(renderer, frame).exposure.adaptedEv100;
    renderer.resize({96, 64});
    frame.camera.forward = -frame.camera.forward; // a new measurement of this view would give
                                                  // another exposure
    frame.resetExposure = false;
    frame.deltaTime = 0;
    EXPECT_EQ(draw(renderer, frame).exposure.adaptedEv100, converged);

    frame = frameOf(scene);
    Renderer fresh(context(), scene, optionsOf({96, 64}));
    EXPECT_EQ(firstDifference(radiance(renderer, frame), radiance(fresh, frame)), -1);
    EXPECT_EQ(readDisplay(context(), renderer), readDisplay(context(), fresh));
}

// The environment is part of both paths, lights places that no lamp reaches, and is visible through
// windows.
TEST_F(RendererTest, EnvironmentLightsTheSceneAndItsBackground)
{
    const Scene dark = openAir(100);
    const FrameOptions frame = frameOf(dark);
    const PixelSize size{160, 90};
    Renderer night(context(), dark, optionsOf(size));
    const Image before = radiance(night, frame);

    Image sky{.width = 64, .height = 32, .channels = 3};
    for (uint32_t i = 0; i < 64 * 32; ++i)
        for (const float channel : {200.0f, 300.0f, i < 64 * 16 ? 500.0f : 100.0f})
            sky.pixels.push_back(channel);
    Scene scene = dark;
    scene.environment = SceneEnvironment{.radiance = sky, .rotation = 1, .scale = 0.5};
    Renderer day(context(), scene, optionsOf(size));
    const Image lit = radiance(day, frame);
    for (size_t i = 0; i < lit.pixels.size(); ++i)
        ASSERT_GE(lit.pixels[i], before.pixels[i]) << i;
    const BruteCheck check = compareWithBruteForce(
        context(), day, frame, lit, checkRects(size, scene.lights.size(), CheckExtent::Full),
        scene.lights.size(), [](double) {});
    EXPECT_LE(check.relative(), BruteCheck::bound);
    // The upper edge of the image shows the sky, with half its luminance.
    EXPECT_NEAR(lit.pixels[0], 100, 1);
    EXPECT_NEAR(lit.pixels[1], 150, 1);
    EXPECT_NEAR(lit.pixels[2], 250, 1);
    const FrameStats stats = draw(day, frame);
    EXPECT_TRUE(std::any_of(stats.passes.begin(), stats.passes.end(), [](const PassTime& p) {
        return p.name == "shade_environment" && p.ms > 0;
    }));
    const FrameStats without = draw(night, frame);
    EXPECT_TRUE(std::none_of(without.passes.begin(), without.passes.end(),
                             [](const PassTime& p) { return p.name == "shade_environment"; }));
}

// A sun is visible in front of the environment, and both light the scene.
TEST_F(RendererTest, EnvironmentDoesNotCoverSuns)
{
    Scene scene = openAir(10);
    FrameOptions frame = frameOf(scene);
    const glm::dvec3 f = frame.camera.forward, up = frame.camera.up;
    const glm::dvec3 toSun = glm::normalize(f + 0.9 * std::tan(frame.camera.verticalFov / 2) * up);
    CndLight sun{.type = CND_LIGHT_DISTANT_SPHERE, .radius = 0.02f, .emission = {1000, 2000, 3000}};
    for (int i = 0; i < 3; ++i)
        sun.direction[i] = float(-toSun[i]);
    scene.lights.push_back(sun);
    scene.environment = SceneEnvironment{
        .radiance = {.width = 2, .height = 1, .channels = 1, .pixels = {100, 100}}};
    Renderer renderer(context(), scene, optionsOf({160, 90}));
    const Image hidden = radiance(renderer, frame);
    frame.lightsVisible = true;
    const Image seen = radiance(renderer, frame);
    size_t pixels = 0;
    for (size_t i = 0; i < seen.pixels.size(); i += 3)
        if (hidden.pixels[i] == 100 && seen.pixels[i] != 100) {
            ++pixels;
            for (size_t c = 0; c < 3; ++c)
                ASSERT_EQ(seen.pixels[i + c], 100 + sun.emission[c]) << i;
        }
    EXPECT_GT(pixels, 5u);
}

// Lights that share no layer with the camera are invisible too.
TEST_F(RendererTest, EmittersAreSeenInTheirLayers)
{
    Scene scene = hall(1000); // few of the first 200 are in sight
    Scene odd = scene;
    odd.lights.clear();
    for (size_t i = 0; i < scene.lights.size(); ++i) {
        scene.lights[i].layers = i % 2 ? 2 : 1;
        if (i % 2)
            odd.lights.push_back(scene.lights[i]);
    }
    FrameOptions frame = frameOf(scene);
    // Returns what visible lights change; they reflect nothing.
    const auto emitters = [&](Renderer& renderer, uint32_t layers) {
        frame.camera.layers = layers;
        frame.lightsVisible = false;
        const Image without = radiance(renderer, frame);
        frame.lightsVisible = true;
        std::vector<float> out = radiance(renderer, frame).pixels;
        for (size_t i = 0; i < out.size(); ++i)
            if (out[i] == without.pixels[i])
                out[i] = 0;
        return out;
    };
    const PixelSize size{160, 90};
    Renderer renderer(context(), scene, optionsOf(size)), only(context(), odd, optionsOf(size));
    const std::vector<float> expected = emitters(only, 0), all = emitters(renderer, 0);
    EXPECT_GT(std::ranges::count_if(expected, [](float x) { return x > 0; }), 20);
    EXPECT_EQ(emitters(renderer, 2), expected);
    renderer.lightsChanged();
    EXPECT_EQ(emitters(renderer, 2), expected);
    EXPECT_EQ(emitters(renderer, 4), std::vector<float>(all.size()));
    EXPECT_EQ(emitters(renderer, 0), all);
    EXPECT_NE(expected, all);
}

TEST_F(RendererTest, EmittersAreBrighterThanWhatTheyLight)
{
    const Scene scene = hall(200);
    FrameOptions frame = frameOf(scene);
    Renderer renderer(context(), scene, optionsOf({320, 180}));
    const Image without = radiance(renderer, frame);
    frame.lightsVisible = true;
    const Image with = radiance(renderer, frame);
    size_t brighter = 0;
    for (size_t i = 0; i < with.pixels.size(); ++i)
        brighter += with.pixels[i] > without.pixels[i];
    EXPECT_GT(brighter, 0u);
    EXPECT_LT(brighter, with.pixels.size() / 4);
}

namespace
{

double luminance(const Image& image, size_t at)
{
    const float* p = &image.pixels[at];
    return 0.2126 * double(p[0]) + 0.7152 * double(p[1]) + 0.0722 * double(p[2]);
}

struct ErrorSummary {
    double mean = 0, p99 = 0;
    size_t pixels = 0;
};

// Summarises the relative error of each lit pixel's luminance.
ErrorSummary relativeError(const Image& image, const Image& truth)
{
    std::vector<double> errors;
    for (size_t i = 0; i < truth.pixels.size(); i += truth.channels)
        if (luminance(truth, i) > 0)
            errors.push_back(std::abs(luminance(image, i) - luminance(truth, i)) /
                             luminance(truth, i));
    if (errors.empty())
        return {};
    const double mean = std::accumulate(errors.begin(), errors.end(), 0.0) / double(errors.size());
    const auto p99 = errors.begin() + std::ptrdiff_t(errors.size() * 99 / 100);
    std::nth_element(errors.begin(), p99, errors.end());
    return {mean, *p99, errors.size()};
}

} // namespace

TEST_F(RendererTest, CompactGBufferIsCloseToFull)
{
    const Scene scene = hall(200);
    FrameOptions frame = frameOf(scene);
    const auto render = [&](CndGBufferLayout layout) {
        Renderer renderer(
            context(), scene,
            {.size = {160, 90}, .gbufferLayout = layout, .specularMethods = 1u << frame.specular});
        return radiance(renderer, frame);
    };
    for (const CndSpecularMethod method : {CND_SPECULAR_KARIS, CND_SPECULAR_CONIC}) {
        frame.specular = method;
        const ErrorSummary error =
            relativeError(render(CND_GBUFFER_COMPACT), render(CND_GBUFFER_FULL));
        std::cout << "method " << method << ": mean " << error.mean << ", p99 " << error.p99
                  << " over " << error.pixels << " pixels\n";
        EXPECT_GT(error.pixels, 160u * 90 / 2) << method;
        // 8-bit colours, F0 and roughness; measured errors are 0.7% and 7.8% (karis), 0.6% and 5.2%
        // (conic). The largest are on chrome: its roughness of 0.12 is stored as 31/255. With
        // that value in the scene the 99th percentile is 2.7% (karis).
        EXPECT_LT(error.mean, 0.01) << method;
        EXPECT_LT(error.p99, 0.09) << method;
        EXPECT_GT(error.mean, 1e-4) << method; // shows that it is another layout
    }
}

TEST_F(RendererTest, FramesInFlightAreTimedAndCounted)
{
    const Scene scene = hall(300, true);
    Renderer renderer(context(), scene, optionsOf({160, 90}));
    uint32_t calls = 0;
    const MeasuredFrames frames = renderFrames(
        context(), renderer, frameOf(scene), {.warmUp = 2, .measured = 5}, true, [&] { ++calls; });
    EXPECT_EQ(calls, 7u);
    EXPECT_EQ(frames.times.frames(), 5u);
    const auto passes = frames.times.summary();
    for (const char* wanted : {"gbuffer_raster", "shade_tiles", "tone_map"})
        EXPECT_TRUE(std::any_of(passes.begin(), passes.end(), [&](const PassSummary& p) {
            return p.name == wanted && p.minMs > 0 && p.minMs <= p.medianMs &&
                   p.medianMs <= p.p95Ms;
        })) << wanted;

    const CndLightingStats stats = countPairs(context(), renderer, frameOf(scene));
    EXPECT_EQ(stats.lightCount, 300u);
    EXPECT_GT(stats.contributingPairs, 0u);
    EXPECT_LE(stats.contributingPairs, stats.insidePairs);
    EXPECT_LE(stats.insidePairs, stats.listedPairs);
    EXPECT_GE(stats.maxListLength, stats.listEntries / std::max(stats.tileCount, 1u));
}

// Frames that keep lists or the lit image have the same bits as frames that keep nothing, whatever
// changes in between.
TEST_F(RendererTest, KeptFramesHaveTheSameBits)
{
    const Scene scene = hall(300, true);
    Renderer keeping(context(), scene, optionsOf({160, 90})),
        fresh(context(), scene, optionsOf({160, 90}));
    FrameOptions frame = frameOf(scene);
    frame.deltaTime = 0.01f;
    const auto runs = [](const FrameStats& stats, const std::string& pass) {
        return std::any_of(stats.plan.begin(), stats.plan.end(),
                           [&](const CndPassPlan& p) { return p.name == pass && !p.skipped; });
    };
    const auto expectSame = [&](bool lit, bool lists, const char* what) {
        const FrameStats stats = draw(keeping, frame);
        EXPECT_EQ(stats.lit, lit) << what;
        EXPECT_EQ(runs(stats, "gbuffer_raster"), lit) << what;
        EXPECT_EQ(runs(stats, "cluster_lists"), lists) << what;
        FrameOptions all = frame;
        all.reuse = Reuse::None;
        const FrameStats whole = draw(fresh, all);
        EXPECT_TRUE(runs(whole, "cluster_lists")) << what;
        EXPECT_EQ(firstDifference(readRadiance(context(), keeping), readRadiance(context(), fresh)),
                  -1)
            << what;
        EXPECT_EQ(readDisplay(context(), keeping), readDisplay(context(), fresh)) << what;
        EXPECT_EQ(stats.exposure.adaptedEv100, whole.exposure.adaptedEv100) << what;
        frame.resetExposure = false;
    };
    for (const Reuse reuse : {Reuse::Lists, Reuse::Lighting}) {
        const bool image = reuse == Reuse::Lighting;
        frame.reuse = Reuse::None;
        expectSame(true, true, "without");
        frame.reuse = reuse;
        frame.exposure.compensation += 1;
        expectSame(!image, false, "exposure");
        frame.countPairs = true;
        expectSame(true, false, "count");
        frame.countPairs = false;
        frame.time += 1;
        expectSame(true, true, "lights");
        expectSame(!image, false, "nothing");
        frame.camera.position.y += 0.1;
        expectSame(true, true, "camera");
        frame.lightsVisible = !frame.lightsVisible;
        expectSame(true, true, "emitters");
        keeping.resize({200, 90});
        fresh.resize({200, 90});
        expectSame(true, true, "size");
    }
}

// A frame that is lit band by band is the frame, and the next one knows that lists are not its own.
TEST_F(RendererTest, FramesInBandsHaveTheSameBits)
{
    const Scene scene = hall(300);
    Renderer whole(context(), scene, optionsOf({160, 90})),
        banded(context(), scene, optionsOf({160, 90}));
    FrameOptions frame = frameOf(scene);
    frame.reuse = Reuse::Lighting;
    for (const uint32_t rows : {90u, 24u, 8u}) {
        frame.camera.position.y += 0.1;
        context().submitAndWait([&](VkCommandBuffer cmd) { banded.recordUnlit(cmd, frame, 1); });
        for (uint32_t row = 0; row < 90; row += rows)
            context().submitAndWait([&](VkCommandBuffer cmd) {
                banded.recordBand(cmd, row / rows % 2, frame, row, std::min(row + rows, 90u));
            });
        const FrameStats stats = draw(whole, frame);
        EXPECT_EQ(firstDifference(readRadiance(context(), banded), readRadiance(context(), whole)),
                  -1)
            << rows;
        EXPECT_EQ(readDisplay(context(), banded), readDisplay(context(), whole)) << rows;
        EXPECT_EQ(banded.exposureStats((90 - 1) / rows % 2).adaptedEv100,
                  stats.exposure.adaptedEv100);
        FrameOptions next = frame;
        next.specular = CND_SPECULAR_KARIS;
        EXPECT_EQ(firstDifference(radiance(banded, next), radiance(whole, next)), -1) << rows;
    }
}

TEST_F(RendererTest, HeatMapsShowWhatWasCounted)
{
    const Scene scene = hall(400);
    Renderer renderer(context(), scene, optionsOf({320, 400})); // leaves room beside the legend
    FrameOptions frame = frameOf(scene);
    const Image plain = radiance(renderer, frame);
    std::vector<std::vector<uint8_t>> pictures{readDisplay(context(), renderer)};
    for (int i = 1; i < heatMapCount; ++i) {
        frame.heatMap = HeatMap(i);
        // the radiance is the same
        EXPECT_EQ(firstDifference(radiance(renderer, frame), plain), -1);
        pictures.push_back(readDisplay(context(), renderer));
        for (int k = 0; k < i; ++k)
            EXPECT_NE(pictures[size_t(i)], pictures[size_t(k)]) << i << " " << k;
    }
    const CndLightingStats stats = renderer.lightingStats(0);
    EXPECT_GT(stats.contributingPairs, 0u);
    frame.heatMap = HeatMap::None;
    draw(renderer, frame);
    EXPECT_EQ(readDisplay(context(), renderer), pictures[0]);
}

// The colours end at the smallest scale that holds 99% of the pixels with a surface.
TEST_F(RendererTest, HeatMapsScaleToTheirPixels)
{
    std::set<uint32_t> scales;
    for (const uint32_t lights : {60u, 4000u}) {
        SCOPED_TRACE(lights);
        const Scene scene = hall(lights);
        const PixelSize size{320, 200};
        Renderer renderer(context(), scene, optionsOf(size));
        FrameOptions frame = frameOf(scene);
        frame.heatMap = HeatMap::LightsPerPixel;
        draw(renderer, frame);
        const std::vector<uint8_t> shown = readDisplay(context(), renderer);
        const std::vector<glm::vec4> pairs = readPairs(context(), renderer);
        const auto surfaces =
            std::count_if(pairs.begin(), pairs.end(), [](const glm::vec4& p) { return p.w > 0; });
        const auto beyond = [&](uint32_t most) {
            return std::count_if(pairs.begin(), pairs.end(),
                                 [&](const glm::vec4& p) { return p.w > 0 && p.x > float(most); });
        };
        uint32_t scale = 0;
        while (beyond(heatMapScaleEnd(scale)) * 100 > surfaces)
            ++scale;
        const float most = float(heatMapScaleEnd(scale));
        scales.insert(scale);
        const Legend legend = heatMapLegend(frame.heatMap, size, heatMapScaleEnd(scale));
        for (size_t i = 0; i < pairs.size(); ++i) {
            const size_t x = i % size.width, y = i / size.width;
            const size_t top = size.height - legend.height;
            if (x < legend.width && y >= top) {
                for (size_t channel = 0; channel < 3; ++channel)
                    EXPECT_EQ(legend.pixels[(y - top) * legend.width + x] >> 8 * channel & 255u,
                              shown[3 * i + channel])
                        << i;
            } else if (pairs[i].w > 0) {
                const float place = std::min(pairs[i].x / most, 1.0f);
                ASSERT_NEAR(float(shown[3 * i + 1]), 255 * viridis(place).y, 2) << i;
            }
        }
    }
    EXPECT_EQ(scales.size(), 2u);
}
