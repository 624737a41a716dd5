// SPDX-License-Identifier: Apache-2.0
// Tests the environment as a light: white furnace, prefiltered and diffuse light against
// double-precision integration, directions, background, refused arguments.
#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <limits>
#include <set>

#include <glm/gtc/matrix_transform.hpp>

#include "gpu/environment_harness.h"
#include "harness/constants.h"
#include "harness/full_tests.h"
#include "reference/albedo.h"
#include "reference/brdf.h"
#include "shared/environment_data.h"

namespace candelabra::test
{
namespace
{

constexpr float surfaceDepth = 0.5f;
const glm::vec4 white(1), noSpecular(0);

// An orthographic camera: from every pixel the eye is in the direction +z of view space.
CpuGBuffer orthographic(uint32_t width, uint32_t height)
{
    CpuGBuffer g{.width = width, .height = height};
    setOrthographic(g.camera, 2, double(width) / height, 0.1, 10);
    return g;
}

void rotateView(CpuGBuffer& g, const glm::dmat3& viewFromWorld)
{
    for (int i = 0; i < 9; ++i)
        g.camera.viewFromWorld[4 * (i / 3) + i % 3] = viewFromWorld[i / 3][i % 3];
}

// Returns rotations whose axes and angles are unrelated to the axes of a cube.
glm::dmat3 someRotation(int i)
{
    const glm::dvec3 axis = glm::normalize(glm::dvec3(std::sin(i * 1.3), std::cos(i * 2.1), 0.4));
    return glm::dmat3(glm::rotate(glm::dmat4(1), 0.7 + 1.9 * i, axis));
}

// A smooth sky with a bright and a faint patch, darker below.
double cloudySky(const glm::dvec3& d)
{
    const auto patch = [&](const glm::dvec3& centre, double width, double peak) {
        return peak * std::exp((glm::dot(d, glm::normalize(centre)) - 1) / (width * width));
    };
    return 1 + 0.6 * d.y + patch({1, 0.5, -0.4}, 0.25, 8) + patch({-0.3, -0.2, 1}, 0.5, 2);
}

// A sun with a radius of 3 degrees, a million times brighter than the rest.
double sunnySky(const glm::dvec3& d)
{
    const double cosine = glm::dot(d, glm::normalize(glm::dvec3(0.4, 0.7, 0.3)));
    return 1 + 1e6 * std::clamp((cosine - std::cos(0.0525)) / 1e-5 + 0.5, 0.0, 1.0);
}

// Integrates over the hemisphere around n, in rings and spokes around n.
double overHemisphere(const glm::dvec3& n, int rings,
                      const std::function<double(const glm::dvec3&, double)>& f)
{
    const glm::dvec3 helper = std::abs(n.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    const glm::dvec3 t = glm::normalize(glm::cross(n, helper)), b = glm::cross(n, t);
    double sum = 0;
    const int spokes = 2 * rings;
    for (int i = 0; i < rings; ++i) {
        const double u = (i + 0.5) / rings, angle = pi / 2 * u * u; // concentrates rings near n
        const double area = std::sin(angle) * pi * u / rings * (2 * pi / spokes);
        for (int j = 0; j < spokes; ++j) {
            const double phi = 2 * pi * (j + 0.5) / spokes;
            const glm::dvec3 l =
                std::cos(angle) * n + std::sin(angle) * (std::cos(phi) * t + std::sin(phi) * b);
            sum += f(l, std::cos(angle)) * area;
        }
    }
    return sum;
}

} // namespace

TEST_F(EnvironmentTest, WhiteFurnace)
{
    if (const char* const why = whyNoReflections())
        GTEST_SKIP() << why;
    setImage(imageOf([](const glm::dvec3&) { return 1; }, 16));
    const std::vector<double> alphas = {0.04, 0.08, 0.15, 0.25, 0.4, 0.6, 0.8, 1.0};
    const std::vector<double> cosines = {0.05, 0.1, 0.2, 0.35, 0.5, 0.7, 0.85, 1.0};
    const auto gridOf = [&](const glm::vec3& albedo, const glm::vec4& F0F90) {
        CpuGBuffer g = orthographic(uint32_t(cosines.size()), uint32_t(alphas.size()));
        for (const double alpha : alphas)
            for (const double NoV : cosines)
                addPixel(g, {surfaceDepth,
                             {std::sqrt(1 - NoV * NoV), 0, NoV},
                             std::sqrt(alpha),
                             albedo,
                             F0F90});
        return g;
    };
    const auto extremes = [](const std::vector<glm::vec4>& radiance) {
        double least = 1e9, most = 0;
        for (const glm::vec4& r : radiance)
            for (int c = 0; c < 3; ++c) {
                least = std::min(least, double(r[c]));
                most = std::max(most, double(r[c]));
            }
        return std::pair(least, most);
    };
    const CpuGBuffer metal = gridOf(glm::vec3(0), white);
    const CpuGBuffer dielectric = gridOf(glm::vec3(1), {0.04f, 0.04f, 0.04f, 1});
    const auto [metalLeast, metalMost] = extremes(shade(metal, {.energyCompensation = true}));
    const auto [least, most] = extremes(shade(dielectric));
    const auto [givenLeast, givenMost] = extremes(shade(dielectric, {.energyCompensation = true}));
    std::cout << "white furnace, alpha 0.04..1: metal " << metalLeast << ".." << metalMost
              << ", dielectric " << least << ".." << most << ", compensated " << givenLeast << ".."
              << givenMost << "\n";
    EXPECT_GE(std::min({metalLeast, least, givenLeast}), 0.99);
    EXPECT_LE(std::max({metalMost, most, givenMost}), 1 + 1e-3);

    // Without energy compensation a white metal reflects its directional albedo.
    const auto plain = shade(metal);
    for (size_t i = 0; i < plain.size(); ++i) {
        const double NoV = cosines[i % cosines.size()], alpha = alphas[i / cosines.size()];
        EXPECT_NEAR(plain[i].x, reference::specularAlbedo(NoV, alpha, 1e-5).a, 2e-3);
    }
    // Summed lobes reflect more light than arrives, which shows that the furnace test can fail.
    EXPECT_GT(extremes(shade(dielectric, {.lobes = CND_LOBES_SUM})).second, 1.03);
}

// Views along the normal, where the split sum equals the whole integral except for shadowing.
TEST_F(EnvironmentTest, PrefilteredLightMatchesDoubleIntegration)
{
    if (const char* const why = whyNoReflections())
        GTEST_SKIP() << why;
    setImage(imageOf(cloudySky, 1024), 256);
    const std::vector<double> roughnesses = {0.0, 0.1, 0.2, 0.3, 0.4, 0.55, 0.7, 0.85, 1.0};
    CpuGBuffer g = orthographic(uint32_t(roughnesses.size()), 1);
    for (const double r : roughnesses)
        addPixel(g, {surfaceDepth, {0, 0, 1}, r, glm::vec3(0), white});
    std::vector<double> sums(roughnesses.size()), worsts(roughnesses.size());
    constexpr int views = 24;
    for (int view = 0; view < views; ++view) {
        const glm::dmat3 viewFromWorld = someRotation(view);
        rotateView(g, viewFromWorld);
        const auto radiance = shade(g);
        const glm::dvec3 n = glm::transpose(viewFromWorld) * glm::dvec3(0, 0, 1);
        for (size_t i = 0; i < roughnesses.size(); ++i) {
            const double alpha = std::max(roughnesses[i] * roughnesses[i], 0.002);
            // The mirror image is compared with the sky itself, because its lobe is narrower than
            // the rings below.
            const double expected =
                alpha < 0.005
                    ? cloudySky(n)
                    : overHemisphere(n, 200, [&](const glm::dvec3& l, double NoL) {
                          return cloudySky(l) * NoL * reference::ggxBrdf(n, n, l, alpha).value;
                      });
            const double error = std::abs(radiance[i].x - expected) / expected;
            sums[i] += error / views;
            worsts[i] = std::max(worsts[i], error);
        }
    }
    for (size_t i = 0; i < roughnesses.size(); ++i) {
        std::cout << "roughness " << roughnesses[i] << ": relative error mean " << sums[i]
                  << ", largest " << worsts[i] << "\n";
        EXPECT_LE(sums[i], 0.012);
        EXPECT_LE(worsts[i], 0.045);
    }
}

TEST_F(EnvironmentTest, DiffuseLightMatchesDoubleIntegration)
{
    CpuGBuffer g = orthographic(1, 1);
    addPixel(g, {surfaceDepth, {0, 0, 1}, 1, glm::vec3(1), noSpecular});
    const struct {
        const char* name;
        Sky sky;
        double bound; // relative to the largest radiance over all normals
    } skies[] = {{"cloudy", cloudySky, 4e-4}, {"sunny", sunnySky, 2.5e-3}};
    for (const auto& [name, skyOf, bound] : skies) {
        const Sky& sky = skyOf;
        setImage(imageOf(sky, 2048), 256);
        std::vector<double> errors;
        double peak = 0;
        for (int view = 0; view < (fullTests() ? 30 : 10); ++view) {
            const glm::dmat3 viewFromWorld = someRotation(view);
            rotateView(g, viewFromWorld);
            const glm::dvec3 n = glm::transpose(viewFromWorld) * glm::dvec3(0, 0, 1);
            const double expected = overHemisphere(
                n, 1200, [&](const glm::dvec3& l, double NoL) { return sky(l) * NoL / pi; });
            errors.push_back(std::abs(shade(g)[0].x - expected));
            peak = std::max(peak, expected);
        }
        double sum = 0, worst = 0;
        for (const double error : errors) {
            sum += error / peak / double(errors.size());
            worst = std::max(worst, error / peak);
        }
        std::cout << name << " sky, diffuse: error over peak mean " << sum << ", largest " << worst
                  << "\n";
        EXPECT_LE(worst, bound) << name;
    }
}

// For a rotated perspective camera in a rotated environment, mirrors and background show the sky of
// the right direction at the right scale.
TEST_F(EnvironmentTest, DirectionsScaleAndBackground)
{
    if (const char* const why = whyNoReflections())
        GTEST_SKIP() << why;
    setImage(imageOf(cloudySky, 1024), 256);
    const glm::dmat3 viewFromWorld = someRotation(3), worldFromEnvironment = someRotation(5);
    CpuGBuffer g{.width = 24, .height = 16};
    setPerspective(g.camera, 1.2, 1.5, 0.1);
    rotateView(g, viewFromWorld);
    for (uint32_t i = 0; i < g.width * g.height; ++i) {
        const bool hole = i % 2;
        addPixel(g, {hole ? 0.0f : depthAt(g.camera, 5), {0.3, 0.2, 1}, 0, glm::vec3(0), white});
    }
    const EnvironmentOptions options{.worldFromEnvironment = worldFromEnvironment,
                                     .scale = 0.5f,
                                     .background = true,
                                     .radianceBefore = 3};
    const auto radiance = shade(g, options);
    const glm::dmat3 environmentFromView = glm::transpose(viewFromWorld * worldFromEnvironment);
    double worst = 0;
    for (uint32_t y = 0; y < g.height; ++y)
        for (uint32_t x = 0; x < g.width; ++x) {
            const size_t i = size_t(y) * g.width + x;
            CpuGBuffer filled = g;
            filled.depth[i] = depthAt(g.camera, 5);
            const glm::dvec3 ray = glm::normalize(viewPosition(filled, x, y));
            const bool hole = i % 2;
            const glm::dvec3 seen = hole ? ray : glm::reflect(ray, storedNormal(g, i));
            const double expected = 3 + 0.5 * cloudySky(glm::normalize(environmentFromView * seen));
            worst = std::max(worst, std::abs(radiance[i].y - expected) / expected);
        }
    std::cout << "mirror and background: largest relative error " << worst << "\n";
    EXPECT_LE(worst, 0.01);

    // Without `background`, pixels without a surface are left alone.
    const auto left = shade(g, {.radianceBefore = 3});
    for (size_t i = 1; i < left.size(); i += 2)
        EXPECT_EQ(left[i], glm::vec4(3));
}

// Values in an image file that are not light.
TEST_F(EnvironmentTest, BrokenPixelsStayFinite)
{
    EXPECT_EQ(gpu::ENVIRONMENT_MAX_LUMINANCE, CND_ENVIRONMENT_MAX_LUMINANCE);
    EnvironmentImage image = imageOf([](const glm::dvec3&) { return 1; }, 32);
    image.pixels[5] = glm::vec4(std::numeric_limits<float>::quiet_NaN());
    image.pixels[40] = glm::vec4(-1e30f);
    image.pixels[77] = glm::vec4(std::numeric_limits<float>::infinity());
    image.pixels[200] = glm::vec4(3e38f);
    setImage(image, 64);
    CpuGBuffer g = orthographic(16, 8);
    for (int i = 0; i < 128; ++i)
        addPixel(g, {i % 5 ? surfaceDepth : 0.0f,
                     {std::sin(i), std::cos(i), 0.1},
                     i / 127.0,
                     glm::vec3(0.5f),
                     {0.5f, 0.04f, 1, 1}});
    for (const glm::vec4& r : shade(g, {.background = true}))
        for (int c = 0; c < 3; ++c)
            EXPECT_TRUE(std::isfinite(r[c]) && r[c] >= 0) << r[c];
}

// Level ground gets the light that the image holds, whatever its size: one bright texel in any row,
// also where the cube is coarser than the image.
TEST_F(EnvironmentTest, LevelGroundGetsAllLightOfOneTexel)
{
    const struct {
        uint32_t width, height, cubeSize;
    } sizes[] = {{64, 32, 64},     {64, 33, 64},    {250, 77, 128}, {256, 128, 64},  {3, 2, 64},
                 {1024, 512, 256}, {1024, 512, 64}, {1, 1, 64},     {4096, 2048, 64}};
    CpuGBuffer g = orthographic(1, 1);
    addPixel(g, {surfaceDepth, {0, 1, 0}, 1, glm::vec3(1), noSpecular});
    uint32_t seed = 1;
    const auto random = [&](uint32_t count) {
        seed = seed * 747796405 + 2891336453;
        return uint32_t(uint64_t(seed) * count >> 32);
    };
    for (const auto& [width, height, cubeSize] : sizes) {
        if (width > 1024 && !fullTests()) // the largest image takes longest
            continue;
        double worst = 0;
        const uint32_t rows = (height + 1) / 2;
        std::set<uint32_t> tried = {0, std::min(1u, rows - 1), rows - 1};
        const int more = fullTests() ? 20 : width < 1000 ? 1 : 0; // large images take long
        for (int i = 0; i < more; ++i)
            tried.insert(random(rows));
        for (const uint32_t y : tried) {
            EnvironmentImage image{width, height, std::vector<glm::vec4>(size_t(width) * height)};
            image.pixels[size_t(y) * width + random(width)] = {1e6, 2e6, 3e6, 1};
            setImage(image, cubeSize);
            const glm::vec4 radiance = shade(g)[0];
            const double top = pi * y / height, bottom = std::min(pi * (y + 1) / height, pi / 2);
            const double solidAngle =
                2 * pi / width * (std::cos(pi * y / height) - std::cos(pi * (y + 1) / height));
            const double onGround =
                pi / width * (std::pow(std::sin(bottom), 2) - std::pow(std::sin(top), 2));
            const double elevation = 90 - 180 * (y + 0.5) / height;
            for (int c = 0; c < 3; ++c) {
                const double error =
                    std::abs(double(radiance[c]) * pi / (1e6 * (c + 1)) - onGround);
                worst = std::max(worst, error / (elevation < 10 ? solidAngle : onGround));
            }
        }
        std::cout << width << "x" << height << ", cube " << cubeSize << ": error " << worst << "\n";
        EXPECT_LE(worst, 1e-4) << width << "x" << height;
    }
}

// Suns of true size over level ground, against the sum over the image in double precision.
TEST_F(EnvironmentTest, LevelGroundGetsAllLightOfTheSun)
{
    constexpr double radius = 0.53 / 2 * pi / 180;
    CpuGBuffer g = orthographic(1, 1);
    addPixel(g, {surfaceDepth, {0, 1, 0}, 1, glm::vec3(1), noSpecular});
    for (const uint32_t width :
         fullTests() ? std::vector<uint32_t>{1024, 2048, 4096} : std::vector<uint32_t>{1024})
        for (const double elevation : {0.2, 3.0, 10.5, 37.0, 89.9}) {
            const double e = elevation * pi / 180;
            const glm::dvec3 sun(std::cos(e) * 0.6, std::sin(e), std::cos(e) * 0.8);
            const EnvironmentImage image = imageOf(
                [&](const glm::dvec3& d) { return glm::distance(d, sun) < radius ? 1e9 : 10; },
                width);
            double onGround = 0, facing = 0; // lx
            for (uint32_t y = 0; y < image.height; ++y) {
                const double top = pi * y / image.height, bottom = pi * (y + 1) / image.height;
                for (uint32_t x = 0; x < image.width; ++x) {
                    const double luminance = double(image.pixels[size_t(y) * image.width + x].x);
                    facing += luminance * 2 * pi / image.width * (std::cos(top) - std::cos(bottom));
                    if (y < image.height / 2)
                        onGround += luminance * pi / image.width *
                                    (std::pow(std::sin(bottom), 2) - std::pow(std::sin(top), 2));
                }
            }
            setImage(image, 64);
            const double error = std::abs(double(shade(g)[0].x) * pi - onGround) /
                                 (elevation < 10 ? facing : onGround);
            std::cout << width << " wide, sun at " << elevation << " degrees: error " << error
                      << "\n";
            EXPECT_LE(error, 1e-4) << width << " " << elevation;
        }
}

// A rough white metal that faces a bright texel reflects what the lobe gets from the texel's
// direction, wherever it lies in the texels of the cube: each step from the image to a level of the
// prefiltered cube keeps sum and first moment.
TEST_F(EnvironmentTest, HighlightsKeepTheLightOfOneTexel)
{
    if (const char* const why = whyNoReflections())
        GTEST_SKIP() << why;
    constexpr uint32_t width = 512;
    CpuGBuffer g = orthographic(4, 1);
    const double roughnesses[] = {0.5, 0.6, 0.75, 1};
    for (const double r : roughnesses)
        addPixel(g, {surfaceDepth, {0, 0, 1}, r, glm::vec3(0), white});
    std::array<double, 4> sums{}, worsts{};
    int count = 0;
    for (const uint32_t y : {1u, 40u, 63u, 64u, 100u, 127u, 190u}) {
        EnvironmentImage image{width, width / 2, std::vector<glm::vec4>(width * width / 2)};
        const uint32_t x = (y * 37) % width;
        image.pixels[size_t(y) * width + x] = glm::vec4(1e6f);
        setImage(image, 64);
        const double theta = pi * (y + 0.5) / image.height, phi = 2 * pi * (x + 0.5) / width;
        const glm::dvec3 l(-std::sin(theta) * std::sin(phi), std::cos(theta),
                           std::sin(theta) * std::cos(phi));
        const double solidAngle =
            2 * pi / width *
            (std::cos(pi * y / image.height) - std::cos(pi * (y + 1) / image.height));
        for (int tilt = 0; tilt < 4; ++tilt) {
            const glm::dvec3 t = glm::normalize(glm::cross(l, glm::dvec3(0.3, 0.2 + tilt, 0.5)));
            for (size_t i = 0; i < 4; ++i) {
                const double alpha = roughnesses[i] * roughnesses[i];
                const double angle = 0.5 * alpha * (tilt + 1) / 2;
                const glm::dvec3 n = std::cos(angle) * l + std::sin(angle) * t;
                const glm::dvec3 b = glm::cross(l, t); // perpendicular to l, t and n
                rotateView(g, glm::transpose(glm::dmat3(b, glm::cross(n, b), n)));
                const double NoL = glm::dot(n, l);
                const double expected =
                    1e6 * solidAngle * NoL * reference::ggxBrdf(n, n, l, alpha).value;
                const double error = std::abs(double(shade(g)[i].x) / expected - 1);
                sums[i] += error;
                worsts[i] = std::max(worsts[i], error);
            }
            ++count;
        }
    }
    for (size_t i = 0; i < 4; ++i) {
        std::cout << "roughness " << roughnesses[i] << ": relative error mean " << sums[i] / count
                  << ", largest " << worsts[i] << "\n";
        EXPECT_LE(sums[i] / count, 0.13); // 0.6 lies between two levels
        EXPECT_LE(worsts[i], 0.35);
    }
}

TEST_F(EnvironmentTest, TimesEveryKernel)
{
    setImage(imageOf(cloudySky, 1024), 256);
    CpuGBuffer g = orthographic(1, 1);
    addPixel(g, {surfaceDepth});
    shade(g);
    CndEnvironmentStats stats{.structSize = sizeof stats};
    ASSERT_EQ(cndGetEnvironmentStats(environment_, 0, &stats), CND_SUCCESS);
    ASSERT_EQ(stats.kernelTimeCount, 1u);
    EXPECT_STREQ(stats.kernelTimes[0].name, "shade_environment");
    std::string names;
    for (uint32_t i = 0; i < stats.mapKernelTimeCount; ++i) {
        names += std::string(stats.mapKernelTimes[i].name) + " ";
        std::cout << stats.mapKernelTimes[i].name << " " << stats.mapKernelTimes[i].ms << " ms\n";
    }
    EXPECT_EQ(names, "dfg_table environment_cube environment_mip environment_cells "
                     "environment_irradiance environment_prefilter ");
    EXPECT_EQ(cndGetEnvironmentStats(environment_, 1, &stats), CND_ERROR_INVALID_ARGUMENT);
}

TEST_F(EnvironmentTest, RefusesInOneSentence)
{
    CndError error{};
    CndEnvironment refused = nullptr;
    const auto create = [&](CndEnvironmentDesc desc) {
        desc.structSize = sizeof desc;
        return cndCreateEnvironment(&deviceDesc(), &desc, &refused, &error);
    };
    EXPECT_EQ(create({.framesInFlight = 0}), CND_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(create({.framesInFlight = 1, .cubeSize = 100}), CND_ERROR_INVALID_ARGUMENT);
    EXPECT_NE(std::string(error.message).find("power of two"), std::string::npos) << error.message;
    EXPECT_EQ(create({.framesInFlight = 1, .cubeSize = 4096}), CND_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(refused, nullptr);

    setImage(imageOf(cloudySky, 64), 64);
    CpuGBuffer g = orthographic(1, 1);
    addPixel(g, {surfaceDepth});
    const Images images = uploadImages(g);
    const auto record = [&](auto change) {
        CndEnvironmentFrame frame = environmentFrame(g, images, {});
        change(frame);
        CndResult result{};
        context().submitAndWait([&](VkCommandBuffer cmd) {
            result = cndRecordEnvironment(environment_, cmd, &frame, &error);
        });
        return result;
    };
    EXPECT_EQ(record([](CndEnvironmentFrame& f) { f.scale = -1; }), CND_ERROR_INVALID_ARGUMENT);
    EXPECT_NE(std::string(error.message).find("scale"), std::string::npos) << error.message;
    EXPECT_EQ(record([](CndEnvironmentFrame& f) { f.worldFromEnvironment[0] = 2; }),
              CND_ERROR_INVALID_ARGUMENT);
    EXPECT_NE(std::string(error.message).find("rotation"), std::string::npos) << error.message;
    EXPECT_EQ(record([](CndEnvironmentFrame& f) { f.frameSlot = 2; }), CND_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(record([](CndEnvironmentFrame& f) { f.depth = VK_NULL_HANDLE; }),
              CND_ERROR_INVALID_ARGUMENT);
    EXPECT_STREQ(error.message, "CndEnvironmentFrame: depth is null");
    EXPECT_EQ(record([](CndEnvironmentFrame& f) { f.radiance = VK_NULL_HANDLE; }),
              CND_ERROR_INVALID_ARGUMENT);
    EXPECT_STREQ(error.message, "CndEnvironmentFrame: radiance is null");
    EXPECT_EQ(record([](CndEnvironmentFrame& f) { f.width = 0; }), CND_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(record([](CndEnvironmentFrame&) {}), CND_SUCCESS) << error.message;
}

} // namespace candelabra::test
