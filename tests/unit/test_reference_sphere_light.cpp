// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

#include "harness/constants.h"
#include "reference/brdf.h"
#include "reference/light.h"
#include "reference/sphere_light.h"
#include "test_reference_support.h"

namespace candelabra::test
{

using namespace candelabra::reference;

namespace
{

// Computes F by integration over the cap: polar angle outside, azimuth inside, split where the
// horizon first cuts a ring.
double bruteFormFactor(double c, double s)
{
    const double sinb = std::sqrt((1 - c) * (1 + c));
    const double edge = std::asin(s);
    const double kink = std::min(edge, std::asin(std::abs(c)));
    const auto ring = [=](double theta) {
        return std::sin(theta) * integratePositivePart(c * std::cos(theta), sinb * std::sin(theta));
    };
    return (integrate(0, kink, ring) + integrate(kink, edge, ring)) / pi;
}

SurfacePoint surfaceAt(const glm::dvec3& toEye)
{
    return {{0, 0, 0}, {0, 1, 0}, glm::normalize(toEye)};
}

Material whiteLambert()
{
    Material material;
    material.diffuseAlbedo = glm::dvec3(1);
    return material;
}

CndLight makePunctual(uint32_t type, const glm::vec3& position, float emission)
{
    CndLight light = makeSphere(position, 1, glm::vec3(emission));
    light.type = type;
    return light;
}

double lit(const SurfacePoint& surface, const Material& material, const CndLight& light)
{
    return outgoingLuminance(surface, material, light, glm::dvec3(0), CND_SPECULAR_KARIS).r;
}

} // namespace

TEST(ReferenceFormFactor, agreesWithBruteForceQuadrature)
{
    WorstCase worst;
    for (const double s : {1e-5, 1e-3, 0.02, 0.2, 0.6, 0.9, 0.999}) {
        for (double x = -1.25; x <= 1.3; x += 0.125) {
            const double c = x * s;
            if (std::abs(c) > 1)
                continue;
            const double error = std::abs(sphereFormFactor(c, s) - bruteFormFactor(c, s));
            worst.add(error / (s * s * s), "s", s, "c/s", x);
        }
    }
    EXPECT_TRUE(worst.within(1e-9));
}

TEST(ReferenceFormFactor, aboveTheHorizonIsTheCosineLaw)
{
    EXPECT_DOUBLE_EQ(sphereFormFactor(0.7, 0.3), 0.7 * 0.3 * 0.3);
    EXPECT_EQ(sphereFormFactor(-0.7, 0.3), 0);
    EXPECT_EQ(sphereFormFactor(1, 0), 0);
    EXPECT_THROW(sphereFormFactor(1.01, 0.5), std::domain_error);
    EXPECT_THROW(sphereFormFactor(0.5, NAN), std::domain_error);
}

TEST(ReferenceFormFactor, splitsAWholeCircle)
{
    WorstCase worst;
    for (const double s : {1e-5, 0.1, 0.7, 1.0}) {
        for (double x = 0; x <= 1; x += 1.0 / 64) {
            const double c = x * s;
            const double split = sphereFormFactor(c, s) - sphereFormFactor(-c, s) - c * s * s;
            worst.add(std::abs(split) / (s * s * s), "s", s, "c/s", x);
        }
    }
    EXPECT_TRUE(worst.within(1e-14));
}

// Through both tangencies, and at s = 1, the value neither jumps nor turns back.
TEST(ReferenceFormFactor, isContinuousAndMonotoneAcrossTheHorizon)
{
    for (const double s : {1e-5, 0.1, 0.9, 1.0}) {
        WorstCase jump, fall;
        const int steps = 20000;
        double previous = sphereFormFactor(std::max(-1.1 * s, -1.0), s);
        for (int i = 1; i <= steps; ++i) {
            const double c = std::clamp(1.1 * s * (2.0 * i / steps - 1), -1.0, 1.0);
            const double value = sphereFormFactor(c, s);
            jump.add((value - previous) / (s * s * s), "s", s, "c", c);
            fall.add((previous - value) / (s * s * s), "s", s, "c", c);
            previous = value;
        }
        // dF/dc <= s^2, and a step of c is 1.1 s / 10000.
        EXPECT_TRUE(jump.within(1.2e-4));
        EXPECT_TRUE(fall.within(1e-15));
    }
}

TEST(ReferenceFormFactor, receiverInsideContinuesTheSurfaceValue)
{
    for (const double c : {-1.0, -0.3, 0.0, 0.4, 1.0})
        EXPECT_DOUBLE_EQ(sphereFormFactor(c, 1), (1 + c) / 2);
    const SurfacePoint surface = surfaceAt({0, 1, 0});
    const glm::dvec3 direction = glm::normalize(glm::dvec3(1, 0.5, 0));
    const double outside = sphereDiffuse(surface, direction * (1 + 1e-10), 1);
    const double inside = sphereDiffuse(surface, direction * 0.5, 1);
    EXPECT_NEAR(outside, inside, 1e-4); // the difference falls like sqrt(d - R)
    EXPECT_DOUBLE_EQ(sphereDiffuse(surface, glm::dvec3(0), 1), 0.5);
}

// Head-on illuminance is pi L s^2 = I / d^2 with I = pi R^2 L and Phi = 4 pi I.
TEST(ReferenceSphereLight, unitsAgreeWithThePointLightOfTheSameIntensity)
{
    const SurfacePoint surface = surfaceAt({0, 1, 0});
    const float radius = 0.25f, luminance = 1000;
    const double intensity = pi * radius * radius * luminance;
    const double E = intensity / 9;
    const CndLight sphere = makeSphere({0, 3, 0}, radius, glm::vec3(luminance));
    EXPECT_NEAR(lit(surface, whiteLambert(), sphere) * pi / E, 1, 1e-12);
    const CndLight point = makePunctual(CND_LIGHT_POINT, {0, 3, 0}, static_cast<float>(intensity));
    EXPECT_NEAR(lit(surface, whiteLambert(), point) * pi / E, 1, 1e-6); // the emission is a float
}

// A white Lambertian plane under a luminous hemisphere (s = 1, straight above) has the luminance of
// the hemisphere.
TEST(ReferenceSphereLight, whiteFurnaceIsOne)
{
    const CndLight dome = makeSphere({0, 2, 0}, 2, glm::vec3(1));
    EXPECT_DOUBLE_EQ(lit(surfaceAt({0, 1, 0}), whiteLambert(), dome), 1);
}

TEST(ReferenceSphereLight, diffuseTendsToThePointLight)
{
    // Above the horizon the sphere equals the point light. In the band where it crosses the horizon
    // the difference is at most 0.2123 s^3, reached at c = 0 (a disc seen edge-on: 2 / (3 pi) s^3).
    WorstCase worst;
    for (const double s : {1e-4, 1e-3, 1e-2}) {
        for (double x = -1; x <= 1; x += 1.0 / 32) {
            const double point = std::max(x, 0.0) * s * s * s;
            worst.add(std::abs(sphereFormFactor(x * s, s) - point) / (s * s * s), "s", s, "x", x);
        }
    }
    EXPECT_TRUE(worst.within(2 / (3 * pi) * (1 + 1e-3)));
    EXPECT_NEAR(sphereFormFactor(0, 1e-4) * 1e12, 2 / (3 * pi), 1e-8);
}

// With constant intensity the exact specular term of a sphere approaches that of the point light
// with an error that falls like R^2. The error of the representative point falls like R, because
// alpha' does.
TEST(ReferenceSphereLight, specularTendsToThePointLight)
{
    const SurfacePoint surface = surfaceAt({0.6, 0.7, 0.1});
    const double alpha = 0.3, distance = 2;
    const glm::dvec3 l = glm::normalize(glm::dvec3(-0.5, 0.8, 0.2));
    const double NoL = glm::dot(surface.normal, l);
    const double point = ggxBrdf(surface.normal, surface.toEye, l, alpha).value * NoL;
    double exact[2], karis[2];
    for (int i = 0; i < 2; ++i) {
        const double radius = 0.02 / (1 << i), s = radius / distance;
        const glm::dvec3 sum = integrateCap(l, s, [&](const glm::dvec3& w) {
            const double cosine = glm::dot(surface.normal, w);
            return glm::dvec3(ggxBrdf(surface.normal, surface.toEye, w, alpha).value * cosine);
        });
        exact[i] = std::abs(sum.x / (pi * s * s) / point - 1);
        // At a tenth of the radius terms of higher order are negligible.
        const double a = karisSphereSpecular(surface, alpha, l * distance, radius / 10).a;
        karis[i] = std::abs(a / (pi * s * s / 100) / point - 1);
    }
    EXPECT_NEAR(exact[0] / exact[1], 4, 0.05);
    EXPECT_LT(exact[0], 1e-3);
    EXPECT_NEAR(karis[0] / karis[1], 2, 0.05);
    EXPECT_LT(karis[0], 0.004);
}

// The eye looks straight into the mirror image of the sphere, where everything is known in closed
// form.
TEST(ReferenceSphereLight, representativePointOnTheAxis)
{
    const double alpha = 0.2, radius = 0.5, distance = 4, s = radius / distance;
    const SurfacePoint surface = surfaceAt({0, 1, 0});
    const SpecularResponse response = karisSphereSpecular(surface, alpha, {0, distance, 0}, radius);
    const double widened = alpha + s / 2;
    EXPECT_NEAR(response.a, s * s / (4 * widened * widened), 1e-15);
    EXPECT_EQ(response.b, 0);
    EXPECT_EQ(karisSphereSpecular(surface, alpha, {0, -distance, 0}, radius).a, 0);
    // If the mirror ray meets the sphere off its centre, the representative direction is the mirror
    // direction.
    const SurfacePoint tilted = surfaceAt({0.6, 0.8, 0});
    const double offset = std::sqrt(16.09), sOffset = radius / offset;
    const double lobe = 1 / (pi * alpha * alpha) * smithVisibility(0.8, 0.8, alpha) * 0.8;
    const double norm = std::pow(alpha / (alpha + sOffset / 2), 2);
    const double hit = karisSphereSpecular(tilted, alpha, {-2.4, 3.2, 0.3}, radius).a;
    EXPECT_NEAR(hit / (pi * sOffset * sOffset * lobe * norm), 1, 1e-12);
    // A receiver inside the sphere, and at its centre: the value is defined and finite.
    EXPECT_GT(karisSphereSpecular(surface, alpha, {0, 0.2, 0}, radius).a, 0);
    EXPECT_EQ(karisSphereSpecular(surface, alpha, {0, 0, 0}, radius).a, 0);
}

TEST(ReferenceSphereLight, windowIsSmoothAtItsRadius)
{
    EXPECT_EQ(lightWindow(0, 2), 1);
    EXPECT_DOUBLE_EQ(lightWindow(1, 2), std::pow(15.0 / 16, 2));
    EXPECT_EQ(lightWindow(2, 2), 0);
    EXPECT_EQ(lightWindow(3, 2), 0);
    EXPECT_EQ(lightWindow(1e30, INFINITY), 1);
    const double h = 1e-5;
    EXPECT_NEAR(lightWindow(2 - h, 2) / h, 0, 1e-4); // value and slope vanish: the window is C1
    EXPECT_GT(lightWindow(2 - h, 2), 0);
}

TEST(ReferenceSphereLight, windowScalesEveryTerm)
{
    const SurfacePoint surface = surfaceAt({0.2, 1, 0});
    Material material = whiteLambert();
    material.f0 = glm::dvec3(0.5);
    material.specularWeight = 1;
    material.alpha = 0.3;
    for (const uint32_t type : {CND_LIGHT_SPHERE, CND_LIGHT_POINT}) {
        CndLight light = makeSphere({0, 2, 0}, 0.5f, glm::vec3(10));
        light.type = type;
        const double uncut = lit(surface, material, light);
        light.influenceRadius = 4;
        EXPECT_NEAR(lit(surface, material, light) / uncut, std::pow(15.0 / 16, 2), 1e-12);
        light.influenceRadius = 2;
        EXPECT_EQ(lit(surface, material, light), 0);
    }
}

TEST(ReferencePunctualLight, spotFadesBetweenItsCones)
{
    const double inner = 0.3, outer = 0.6;
    const auto at = [&](double cosine) { return spotAttenuation((1 - cosine) / 2, inner, outer); };
    EXPECT_EQ(at(1), 1);
    EXPECT_NEAR(at(std::cos(inner)), 1, 1e-14);
    EXPECT_EQ(at(std::cos(0.61)), 0);
    EXPECT_NEAR(at((std::cos(inner) + std::cos(outer)) / 2), 0.25, 1e-14);

    CndLight spot = makePunctual(CND_LIGHT_SPOT, {0, 2, 0}, 12);
    spot.innerConeAngle = 0.3f;
    spot.outerConeAngle = 0.6f;
    spot.direction[1] = -1;
    EXPECT_NEAR(lit(surfaceAt({0, 1, 0}), whiteLambert(), spot), 12 / (4 * pi), 1e-14);
    spot.direction[1] = 1; // the spot points away
    EXPECT_EQ(lit(surfaceAt({0, 1, 0}), whiteLambert(), spot), 0);
}

TEST(ReferencePunctualLight, directionalIsIlluminance)
{
    CndLight sun = makePunctual(CND_LIGHT_DIRECTIONAL, {0, 0, 0}, 100000);
    sun.direction[1] = -0.8f;
    sun.direction[0] = 0.6f;
    EXPECT_NEAR(lit(surfaceAt({0, 1, 0}), whiteLambert(), sun), 80000 / pi, 1e-2);
    sun.direction[1] = 0.8f;
    EXPECT_EQ(lit(surfaceAt({0, 1, 0}), whiteLambert(), sun), 0);
}

// In the mirror direction at a grazing view VoH is 0.2, so Schlick's weight is 0.8^5.
TEST(ReferencePunctualLight, fresnelMixesF0AndF90)
{
    const double cosine = 0.2, sine = std::sqrt(1 - cosine * cosine), p = std::pow(0.8, 5);
    const SurfacePoint surface = surfaceAt({sine, cosine, 0});
    const glm::vec3 position(-2 * sine, 2 * cosine, 0);
    for (const uint32_t type : {CND_LIGHT_POINT, CND_LIGHT_SPHERE}) {
        CndLight light = makeSphere(position, 0.1f, glm::vec3(10));
        light.type = type;
        Material material;
        material.alpha = 0.4;
        material.f0 = glm::dvec3(1);
        material.specularWeight = 1;
        const double one = lit(surface, material, light); // F0 = F90 = 1: no Fresnel effect
        material.specularWeight = 0;
        EXPECT_NEAR(lit(surface, material, light) / one, 1 - p, 1e-6);
        material.f0 = glm::dvec3(0.04);
        material.specularWeight = 0.5;
        EXPECT_NEAR(lit(surface, material, light) / one, 0.04 * (1 - p) + 0.5 * p, 1e-6);
    }
}

TEST(ReferencePunctualLight, specularIsBrdfTimesIlluminance)
{
    const SurfacePoint surface = surfaceAt({0, 1, 0});
    Material material;
    material.f0 = glm::dvec3(0.04);
    material.specularWeight = 1;
    material.alpha = 0.5;
    const CndLight point = makePunctual(CND_LIGHT_POINT, {0, 2, 0}, 8);
    // E = 2 lx; D V = 1 / (4 pi alpha^2) = 1 / pi at normal incidence.
    EXPECT_NEAR(lit(surface, material, point), 0.04 * 2 / pi, 1e-14);
    EXPECT_EQ(outgoingLuminance(surface, material, point, glm::dvec3(0), CND_SPECULAR_NONE).r, 0);
    CndLight unknown = point;
    unknown.type = 17;
    EXPECT_THROW(lit(surface, material, unknown), std::invalid_argument);
}

} // namespace candelabra::test
