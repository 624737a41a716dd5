// SPDX-License-Identifier: Apache-2.0
// Tests the reference renderer against images of an independent path tracer, and its geometry.
#include <cmath>
#include <numbers>
#include <span>
#include <stdexcept>

#include <gtest/gtest.h>

#include "data/path_traced.h"
#include "reference/brdf.h"
#include "reference/render.h"
#include "test_reference_support.h"

namespace candelabra::test
{

using namespace candelabra::reference;

namespace
{

constexpr double radiansPerDegree = std::numbers::pi / 180;
constexpr uint32_t size = 256;

Scene planeScene(const glm::dvec3& eye, const glm::dvec3& target, const glm::dvec3& up,
                 double fovDegrees)
{
    Scene scene;
    scene.camera = {eye, target - eye, up, fovDegrees * radiansPerDegree, 1};
    scene.objects.push_back({});
    scene.materials.push_back({});
    scene.materials[0].diffuseAlbedo = glm::dvec3(0.8);
    return scene;
}

// Returns the mean of |candidate - truth| / truth over the lit pixels.
double meanRelativeError(const Image& image, std::span<const PathTracedPixel<1>> truth)
{
    double sum = 0;
    for (const auto& pixel : truth) {
        const double expected = pixel.luminance[0];
        sum += std::abs(image.at(pixel.column, pixel.row).g - expected) / expected;
    }
    return sum / static_cast<double>(truth.size());
}

// The accepted error: 0.3 % for the model plus the mean magnitude (0.8 rms) of the path tracer's
// noise.
double acceptedError(double noiseRms)
{
    return 0.003 + 0.8 * noiseRms;
}

} // namespace

TEST(ReferenceRender, lambertPlaneUnderASphereMatchesThePathTracer)
{
    Scene scene = planeScene({0, 2, 4}, {0, 0, 0}, {0, 1, 0}, 45);
    scene.lights.push_back(makeSphere({0, 3, 0}, 0.5f, glm::vec3(10)));
    const Image image = render(scene, size, size, CND_SPECULAR_KARIS);
    const double error = meanRelativeError(image, planeAbove);
    RecordProperty("meanRelativeError", std::to_string(error));
    EXPECT_LE(error, acceptedError(0.000278));
}

TEST(ReferenceRender, lambertPlaneCutByASphereMatchesThePathTracer)
{
    Scene scene = planeScene({3.1, 4, 0}, {3.1, 0, 0}, {0, 0, -1}, 56);
    scene.lights.push_back(makeSphere({0, -0.4f, 0}, 1, glm::vec3(10)));
    const Image image = render(scene, size, size, CND_SPECULAR_KARIS);
    const double error = meanRelativeError(image, planeCrossing);
    RecordProperty("meanRelativeError", std::to_string(error));
    EXPECT_LE(error, acceptedError(0.00446));
}

// Integrates the BRDF over the light by brute force, for a dielectric at a grazing view: D, Smith,
// Schlick and Lambert together, without an area-light approximation.
TEST(ReferenceRender, integratedBrdfMatchesThePathTracer)
{
    const glm::dvec3 albedo(0.2, 0.3, 0.5), center(0.5, 1.2, -3);
    const double f0 = 0.04, alpha = 0.1, radius = 0.4, luminance = 10;
    const Scene scene = planeScene({0, 0.5, 3}, {0, 0, 0.6476849452607727}, {0, 1, 0}, 20);
    double sum = 0;
    for (const auto& pixel : dielectricGrazing) {
        const auto hit = tracePixel(scene, size, size, pixel.column, pixel.row);
        ASSERT_TRUE(hit);
        const SurfacePoint& surface = hit->surface;
        const glm::dvec3 toCenter = center - surface.position;
        const double s = radius / glm::length(toCenter);
        const glm::dvec3 value =
            integrateCap(glm::normalize(toCenter), s, [&](const glm::dvec3& l) {
                const SpecularBrdf lobe = ggxBrdf(surface.normal, surface.toEye, l, alpha);
                const double fresnel = f0 + (1 - f0) * lobe.schlickWeight;
                const double cosine = glm::dot(surface.normal, l);
                return (albedo * lambertBrdf() + lobe.value * fresnel) * cosine;
            });
        for (int i = 0; i < 3; ++i)
            sum += std::abs(luminance * value[i] / pixel.luminance[i] - 1);
    }
    const double error = sum / (3 * std::size(dielectricGrazing));
    RecordProperty("meanRelativeError", std::to_string(error));
    EXPECT_LE(error, acceptedError(0.0052));
}

TEST(ReferenceRender, ballIsHitOnItsNearSide)
{
    Scene scene;
    scene.camera = {{0, 0, 5}, {0, 0, -1}, {0, 1, 0}, 60 * radiansPerDegree, 1};
    scene.materials.push_back({});
    scene.objects.push_back({Object::Type::Ball, {0, 0, 0}, {}, 1, 0});
    const auto hit = tracePixel(scene, 1, 1, 0, 0);
    ASSERT_TRUE(hit);
    EXPECT_NEAR(glm::distance(hit->surface.position, glm::dvec3(0, 0, 1)), 0, 1e-15);
    EXPECT_NEAR(glm::distance(hit->surface.normal, glm::dvec3(0, 0, 1)), 0, 1e-15);
    // The ball's rim seen from a distance of 5 is at the angle asin(1/5): just inside it hits, just
    // outside misses.
    const double rim = std::tan(std::asin(0.2));
    scene.camera.verticalFov = 2 * std::atan(2 * rim * (1 - 1e-9));
    EXPECT_TRUE(tracePixel(scene, 2, 1, 1, 0));
    scene.camera.verticalFov = 2 * std::atan(2 * rim * (1 + 1e-9));
    EXPECT_FALSE(tracePixel(scene, 2, 1, 1, 0));
    scene.camera.position = glm::dvec3(0); // from inside nothing is visible
    EXPECT_FALSE(tracePixel(scene, 1, 1, 0, 0));
}

TEST(ReferenceRender, planeIsSeenFromAboveOnlyAndTheNearestObjectWins)
{
    Scene scene = planeScene({0, 2, 0}, {0, 0, 0}, {0, 0, -1}, 40);
    scene.materials.push_back({});
    scene.objects.push_back({Object::Type::Ball, {0, -5, 0}, {}, 1, 1});
    EXPECT_EQ(tracePixel(scene, 1, 1, 0, 0)->material, 0u);
    scene.objects[1].point.y = 0.5;
    EXPECT_EQ(tracePixel(scene, 1, 1, 0, 0)->material, 1u);
    scene.camera = {{0, -2, 0}, {0, 1, 0}, {0, 0, -1}, 0.7, 1};
    scene.objects.pop_back();
    scene.background = glm::dvec3(3);
    EXPECT_EQ(renderPixel(scene, 1, 1, 0, 0, CND_SPECULAR_NONE), glm::dvec3(3));
}

TEST(ReferenceRender, columnsRunRightAndRowsRunDown)
{
    const Scene scene = planeScene({0, 2, 4}, {0, 0, 0}, {0, 1, 0}, 45);
    const auto topLeft = tracePixel(scene, 4, 4, 0, 0);
    const auto bottomRight = tracePixel(scene, 4, 4, 3, 3);
    ASSERT_TRUE(topLeft && bottomRight);
    EXPECT_LT(topLeft->surface.position.x, 0);
    EXPECT_LT(topLeft->surface.position.z, bottomRight->surface.position.z);
    EXPECT_GT(bottomRight->surface.position.x, 0);
}

TEST(ReferenceRender, emissionAndLightOriginAreAdded)
{
    Scene scene = planeScene({0, 2, 4}, {0, 0, 0}, {0, 1, 0}, 45);
    scene.lights.push_back(makeSphere({0, 3, 0}, 0.5f, glm::vec3(10)));
    const glm::dvec3 plain = renderPixel(scene, 3, 3, 1, 1, CND_SPECULAR_NONE);
    scene.lightOrigin = {0, 2, 0};
    scene.lights[0].position[1] = 1;
    scene.materials[0].emission = glm::dvec3(7, 8, 9);
    const glm::dvec3 moved = renderPixel(scene, 3, 3, 1, 1, CND_SPECULAR_NONE);
    EXPECT_NEAR(glm::distance(moved, plain + glm::dvec3(7, 8, 9)), 0, 1e-14);
}

TEST(ReferenceRender, impossibleScenesAreRefused)
{
    const Scene good = planeScene({0, 2, 4}, {0, 0, 0}, {0, 1, 0}, 45);
    Scene scene = good;
    scene.camera.up = scene.camera.forward;
    EXPECT_THROW(render(scene, 2, 2, CND_SPECULAR_NONE), std::invalid_argument);
    scene = good;
    scene.materials[0].alpha = 0;
    EXPECT_THROW(render(scene, 2, 2, CND_SPECULAR_NONE), std::invalid_argument);
    scene = good;
    scene.objects[0].material = 5;
    EXPECT_THROW(render(scene, 2, 2, CND_SPECULAR_NONE), std::invalid_argument);
    EXPECT_THROW(render(good, 0, 2, CND_SPECULAR_NONE), std::invalid_argument);
}

} // namespace candelabra::test
