// SPDX-License-Identifier: Apache-2.0
// Tests the truth about spheres: two integrators in different domains, limits, and its error
// estimate.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <random>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include "harness/constants.h"
#include "harness/full_tests.h"
#include "reference/brdf.h"
#include "reference/direction_domain.h"
#include "reference/light.h"
#include "reference/quadrature.h"
#include "reference/slope_domain.h"
#include "reference/sphere_light.h"
#include "reference/truth.h"
#include "test_reference_support.h"

namespace candelabra::test
{

using namespace candelabra::reference;

namespace
{

struct CapCase {
    SurfacePoint surface;
    double alpha;
    SphereCap cap;
};

SurfacePoint eyeAt(double angle)
{
    return {{0, 0, 0}, {0, 0, 1}, {std::sin(angle), 0, std::cos(angle)}};
}

// Perceptual roughness 0.0447..1 (alpha 0.002..1), half angle 0.005..89 degrees, view angle up to
// 89 degrees. Three in five centres are near the mirror direction, the others anywhere visible.
CapCase randomCase(std::mt19937_64& random)
{
    std::uniform_real_distribution<double> unit(0, 1);
    const double roughness = 0.0447 + (1 - 0.0447) * unit(random);
    const double s = std::sin(0.005 * std::pow(89 / 0.005, unit(random)) * pi / 180);
    CapCase out{eyeAt(unit(random) * 89 * pi / 180), roughness * roughness, {}};
    const glm::dvec3& v = out.surface.toEye;
    const double phi = 2 * pi * unit(random);
    if (unit(random) < 0.6) {
        const double reach = (s + 2 * out.alpha) * std::tan(1.5 * unit(random)) / 2;
        out.cap.axis = glm::normalize(glm::dvec3(-v.x, 0, v.z) +
                                      reach * std::cos(phi) * glm::dvec3(v.z, 0, v.x) +
                                      reach * std::sin(phi) * glm::dvec3(0, 1, 0));
    } else {
        const double z = -s + unit(random) * (1 + s), across = std::sqrt(std::max(0.0, 1 - z * z));
        out.cap.axis = {across * std::cos(phi), across * std::sin(phi), z};
    }
    out.cap.sin2 = std::min(s * s, maxSpecularSin2);
    return out;
}

// Returns the response of a cap of this size in the mirror direction, which is close to the largest
// possible.
double peakOf(const CapCase& c)
{
    const glm::dvec3& v = c.surface.toEye;
    return slopeDomainSpecular(c.surface, c.alpha, {{-v.x, 0, v.z}, c.cap.sin2}, 1e-3).a;
}

} // namespace

TEST(ReferenceQuadrature, isExactForPolynomialsAndHonestAboutTheRest)
{
    const std::array<double, 2> ends = {0, 2};
    for (int power = 0; power <= 22; ++power) { // up to the degree of the Kronrod rule
        const auto sum =
            reference::integrate<1, 2>(std::span<const double>(ends), 1, 0, [&](double x) {
                return std::array<double, 1>{std::pow(x, power)};
            });
        const double exact = std::pow(2, power + 1) / (power + 1);
        EXPECT_NEAR(sum.value[0] / exact, 1, 4e-15) << power;
    }
    // A kink at an unknown place, and a narrow peak.
    const auto sum =
        reference::integrate<2, 200>(std::span<const double>(ends), 1e-9, 0, [](double x) {
            const double t = (x - 0.7) / 1e-3;
            return std::array<double, 2>{std::sqrt(std::abs(x - 0.3)), 1 / (1 + t * t)};
        });
    const double kink = 2.0 / 3 * (std::pow(0.3, 1.5) + std::pow(1.7, 1.5));
    const double peak = 1e-3 * (std::atan(1300) + std::atan(700));
    EXPECT_TRUE(sum.converged);
    EXPECT_LE(std::abs(sum.value[0] - kink), std::max(sum.error[0], 1e-15));
    EXPECT_LE(sum.error[0], 1e-9 * kink);
    EXPECT_LE(std::abs(sum.value[1] - peak), 1e-9 * peak);
    // An integral that cannot be resolved must say so.
    const auto wild =
        reference::integrate<1, 4>(std::span<const double>(ends), 1e-12, 0, [](double x) {
            return std::array<double, 1>{std::sin(1000 * x * x)};
        });
    EXPECT_FALSE(wild.converged);
}

TEST(ReferenceTruth, twoIntegratorsInDifferentDomainsAgree)
{
    const int count = fullTests() ? 20000 : 400;
    std::mt19937_64 random(1);
    std::vector<double> differences;
    WorstCase worst;
    int unconverged = 0;
    for (int i = 0; i < count; ++i) {
        const CapCase c = randomCase(random);
        const LightResponse slopes = slopeDomainSpecular(c.surface, c.alpha, c.cap, 1e-6);
        const LightResponse directions =
            directionDomainSpecular(c.surface, c.alpha, *capOutline(c.cap), 1e-6);
        unconverged += !slopes.converged + !directions.converged;
        const double floor = 1e-2 * peakOf(c); // compares to 1e-4 of the value or 1e-6 of the peak
        const double a = std::abs(slopes.a - directions.a) / std::max(slopes.a, floor);
        const double b = std::abs(slopes.b - directions.b) / std::max(slopes.b, floor);
        differences.push_back(std::max(a, b));
        worst.add(std::max(a, b), "alpha", c.alpha, "s", c.cap.sine(), "NoV", c.surface.toEye.z,
                  "axis", c.cap.axis.x, c.cap.axis.y, c.cap.axis.z);
    }
    std::sort(differences.begin(), differences.end());
    std::cout << count << " configurations: relative difference median "
              << differences[differences.size() / 2] << ", p99 "
              << differences[differences.size() * 99 / 100] << ", max " << differences.back()
              << "; not converged " << unconverged << "\n";
    EXPECT_TRUE(worst.within(1e-4));
    EXPECT_EQ(unconverged, 0);
}

// With a loose tolerance the error, judged by a tight tolerance, is within the estimate.
TEST(ReferenceTruth, errorEstimateCoversTheError)
{
    std::mt19937_64 random(2);
    const int count = 300;
    int beyond = 0;
    double largest = 0;
    for (int i = 0; i < count; ++i) {
        const CapCase c = randomCase(random);
        const LightResponse exact = slopeDomainSpecular(c.surface, c.alpha, c.cap, 1e-10);
        const LightResponse rough = slopeDomainSpecular(c.surface, c.alpha, c.cap, 1e-3);
        const double error = std::abs(rough.a - exact.a);
        beyond += error > rough.aError + exact.aError + 1e-13 * exact.a;
        if (exact.a > 0)
            largest = std::max(largest, error / exact.a);
    }
    std::cout << "error beyond the estimate in " << beyond << " of " << count
              << "; largest relative error at tolerance 1e-3: " << largest << "\n";
    EXPECT_LE(beyond, count / 100);
    EXPECT_LE(largest, 1e-3);
}

TEST(ReferenceTruth, smallSpheresAreBrdfTimesSolidAngle)
{
    WorstCase worst;
    for (const double alpha : {0.01, 0.1, 0.5, 1.0})
        for (const double NoV : {0.1, 0.5, 1.0})
            for (const double offset : {-0.5, 0.0, 0.3}) {
                const SurfacePoint surface = eyeAt(std::acos(NoV));
                const double angle = std::acos(NoV) + offset * alpha;
                const glm::dvec3 l(-std::sin(angle), 0, std::cos(angle));
                if (l.z < 0.05)
                    continue;
                const double s = 1e-5;
                const SpecularBrdf brdf = ggxBrdf(surface.normal, surface.toEye, l, alpha);
                const LightResponse r = truthOfCap(surface, alpha, {l, s * s}, 1e-7);
                const double point = pi * s * s * brdf.value * l.z;
                worst.add(std::abs(r.a / point - 1), alpha, NoV, offset);
                worst.add(std::abs(r.b / point - brdf.schlickWeight), alpha, NoV, offset);
            }
    EXPECT_TRUE(worst.within(1e-4)); // s^2 / alpha^2 / NoV^2
}

TEST(ReferenceTruth, smoothSurfacesShowTheMirrorImage)
{
    const SurfacePoint surface = eyeAt(1.0);
    const double alpha = 0.002;
    const glm::dvec3 mirror(-surface.toEye.x, 0, surface.toEye.z);
    const LightResponse inside = truthOfCap(surface, alpha, {mirror, 0.04}, 1e-6);
    EXPECT_NEAR(inside.a, 1, 4e-4); // minus the lobe's tail beyond the cap: (alpha / 0.1)^2
    EXPECT_NEAR(inside.b, std::pow(1 - surface.toEye.z, 5), 4e-4);
    const Frame frame = frameAround(mirror, surface.normal);
    const double away = std::asin(0.2) + 0.1;
    const glm::dvec3 aside = std::cos(away) * mirror + std::sin(away) * frame.y;
    EXPECT_LE(truthOfCap(surface, alpha, {aside, 0.04}, 1e-6).a, 1e-3);
    const glm::dvec3 edge = std::cos(std::asin(0.2)) * mirror + 0.2 * frame.y;
    EXPECT_NEAR(truthOfCap(surface, alpha, {edge, 0.04}, 1e-6).a, 0.5, 0.02); // the edge is curved
}

TEST(ReferenceTruth, nothingComesFromBelowTheHorizon)
{
    const SurfacePoint surface = eyeAt(1.2);
    const double s = 0.3;
    const auto at = [&](double z) {
        return truthOfCap(surface, 0.3, {{-std::sqrt(1 - z * z), 0, z}, s * s}, 1e-8);
    };
    EXPECT_EQ(at(-s).a, 0);
    EXPECT_EQ(at(-s).f, 0);
    EXPECT_EQ(at(-0.9).b, 0);
    // The response rises like the power 5/2 of the width of the visible sliver (3/2 for the area,
    // one more for shadowing), without a jump.
    EXPECT_GT(at(-s + 1e-4).a, 0);
    EXPECT_LE(at(-s + 1e-4).a, 1e-6);
    EXPECT_LE(std::abs(at(-1e-9).a - at(1e-9).a), 1e-7);
    EXPECT_LE(std::abs(at(s - 1e-9).a - at(s + 1e-9).a), 1e-7);
}

// In the corners of its domain every response is finite and not negative, a <= 1 and b <= a, in
// both integration domains.
TEST(ReferenceTruth, holdsInTheCornersOfItsDomain)
{
    int count = 0;
    for (const double alpha : {1e-4, 0.002, 0.05, 1.0})
        for (const double view : {0.0, 1e-9, 1e-4, 0.5, 1.5, 1.5707, 1.7})
            for (const double s : {1e-9, 1e-4, 0.3, 0.9999, 1.0}) {
                const SurfacePoint surface = eyeAt(view);
                const glm::dvec3 v = surface.toEye, mirror(-v.x, 0, std::abs(v.z));
                const double across = std::sqrt(1 - s * s);
                for (const glm::dvec3& axis :
                     {glm::dvec3(0, 0, 1), mirror, v, glm::dvec3(-1, 0, 0), glm::dvec3(0, 1, 0),
                      glm::dvec3(-across, 0, -s), glm::dvec3(-across, 0, s),
                      glm::dvec3(0, across, -s * (1 - 1e-12)),
                      across * mirror + s * glm::dvec3(0, 1, 0)}) {
                    const SphereCap cap{glm::normalize(axis), std::min(s * s, maxSpecularSin2)};
                    for (const LightResponse& r :
                         {truthOfCap(surface, alpha, cap, 1e-3),
                          directionDomainSpecular(surface, alpha, *capOutline(cap), 1e-3)}) {
                        ++count;
                        EXPECT_TRUE(r.a >= 0 && r.b >= 0 && r.f >= 0 && r.a <= 1.0001 &&
                                    r.b <= r.a && r.f <= 1 + 1e-12)
                            << alpha << " " << view << " " << s << " axis " << axis.x << " "
                            << axis.y << " " << axis.z << ": " << r.a << " " << r.b << " " << r.f;
                    }
                }
            }
    std::cout << count << " responses\n";
}

TEST(ReferenceTruth, receiversInsideASphereContinueItsSurface)
{
    const SurfacePoint surface = eyeAt(0.7);
    CndLight light = makeSphere({0.6f, 0, 0.8f}, 1, glm::vec3(1));
    const auto response = [&](double distance) {
        SurfacePoint moved = surface;
        moved.position = (1 - distance) * glm::dvec3(light.position[0], 0, light.position[2]);
        return truthResponse(moved, 0.3, light, glm::dvec3(0), 1e-7);
    };
    const LightResponse outside = response(1 + 1e-9), inside = response(1 - 1e-9);
    EXPECT_NEAR(outside.f, (1 + 0.8) / 2, 2e-4); // the difference falls with the square root of the
                                                 // height
    EXPECT_NEAR(inside.f, outside.f, 1e-4);
    EXPECT_NEAR(inside.a, outside.a, 1e-6);
    EXPECT_NEAR(response(0.25).a, inside.a, 1e-6);
    SurfacePoint centre = surface;
    centre.position = {light.position[0], light.position[1], light.position[2]};
    EXPECT_EQ(truthResponse(centre, 0.3, light, glm::dvec3(0), 1e-6).f, 0.5);
    EXPECT_EQ(truthResponse(centre, 0.3, light, glm::dvec3(0), 1e-6).a, 0);
}

TEST(ReferenceTruth, luminanceCollectsLobesWindowAndEmission)
{
    const SurfacePoint surface = eyeAt(0.9);
    Material material;
    material.diffuseAlbedo = {0.5, 0.25, 0.125};
    material.f0 = {0.04, 0.5, 1};
    material.specularWeight = 0.75;
    material.alpha = 0.2;
    CndLight light = makeSphere({-1, 0.5f, 1.5f}, 0.5f, {10, 20, 40});
    light.influenceRadius = 4;
    const LightResponse r = truthResponse(surface, 0.2, light, glm::dvec3(0), 1e-8);
    const double window = lightWindow(std::sqrt(1 + 0.25 + 2.25), 4);
    const glm::dvec3 expected =
        glm::dvec3(10, 20, 40) * window *
        (material.diffuseAlbedo * r.f + material.f0 * (r.a - r.b) + glm::dvec3(0.75 * r.b));
    const glm::dvec3 got = truthLuminance(surface, material, light, glm::dvec3(0), 1e-8).luminance;
    EXPECT_LE(glm::distance(got, expected), 1e-12 * glm::length(expected));
    light.influenceRadius = 1;
    EXPECT_EQ(truthLuminance(surface, material, light, glm::dvec3(0), 1e-8).luminance,
              glm::dvec3(0));

    // A distant sphere is a sphere far away, and a point light is a small sphere of the same
    // intensity.
    light = makeSphere({-1e6f, 2e6f, 3e6f}, 2e5f, {10, 20, 40});
    const glm::dvec3 far = truthLuminance(surface, material, light, glm::dvec3(0), 1e-8).luminance;
    CndLight distant = light;
    distant.type = CND_LIGHT_DISTANT_SPHERE;
    distant.radius = static_cast<float>(2e5 / std::sqrt(14e12));
    const glm::dvec3 toSun = glm::normalize(glm::dvec3(-1, 2, 3));
    for (int i = 0; i < 3; ++i)
        distant.direction[i] = static_cast<float>(-toSun[i]);
    const glm::dvec3 sun =
        truthLuminance(surface, material, distant, glm::dvec3(0), 1e-8).luminance;
    EXPECT_LE(glm::distance(sun, far), 1e-6 * glm::length(far));
    double previous = 1;
    for (const float radius : {0.1f, 0.01f, 0.001f}) {
        const float luminance = static_cast<float>(1 / (pi * radius * radius));
        CndLight small = makeSphere({-1, 0.5f, 1.5f}, radius, glm::vec3(luminance));
        CndLight point = small;
        point.type = CND_LIGHT_POINT;
        for (float& emission : point.emission)
            emission = 1;
        const glm::dvec3 a =
            truthLuminance(surface, material, small, glm::dvec3(0), 1e-9).luminance;
        const glm::dvec3 b =
            truthLuminance(surface, material, point, glm::dvec3(0), 1e-9).luminance;
        EXPECT_EQ(b,
                  outgoingLuminance(surface, material, point, glm::dvec3(0), CND_SPECULAR_KARIS));
        const double error = glm::distance(a, b) / glm::length(b);
        EXPECT_LE(error, previous / 50); // falls with the square of the radius
        previous = error;
    }
    std::cout << "sphere of 1 mm at 1.9 m against a point: " << previous << "\n";
    light.type = 99;
    EXPECT_THROW(truthLuminance(surface, material, light, glm::dvec3(0), 1e-6),
                 std::invalid_argument);
}

} // namespace candelabra::test
