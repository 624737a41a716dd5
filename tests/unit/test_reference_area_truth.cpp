// SPDX-License-Identifier: Apache-2.0
// Tests the truth about area lights: closed forms and limits of rectangles, discs and tubes, and
// for every type a second integrator over the emitter's surface and a third along its outline.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "harness/constants.h"
#include "harness/full_tests.h"
#include "reference/arc_domain.h"
#include "reference/emitter_domain.h"
#include "reference/truth.h"
#include "scene/polygons.h"
#include "test_reference_support.h"

namespace candelabra::test
{

using namespace candelabra::reference;

namespace
{

const SurfacePoint upward{{0, 0, 0}, {0, 0, 1}, {0.6, 0, 0.8}};

double formFactor(const CndLight& light)
{
    return truthResponse(upward, 0, light, glm::dvec3(0), 1e-10).f;
}

double specular(const CndLight& light, double alpha = 0.25)
{
    return truthResponse(upward, alpha, light, glm::dvec3(0), 1e-8).a;
}

} // namespace

TEST(ReferenceAreaTruth, twoIntegratorsInDifferentDomainsAgree)
{
    const int count = fullTests() ? 3000 : 60;
    const auto unitVector = [](std::mt19937_64& random) {
        std::uniform_real_distribution<double> unit(0, 1);
        const double z = 2 * unit(random) - 1, phi = 2 * pi * unit(random);
        const double across = std::sqrt(1 - z * z);
        return glm::dvec3(across * std::cos(phi), across * std::sin(phi), z);
    };
    for (uint32_t type = 0; type < CND_LIGHT_TYPE_COUNT; ++type) {
        if (cndIsDistant(type) || cndIsPunctual(type))
            continue;
        const uint32_t fields = cndLightFields(type);
        const bool alongAxis =
            fields & CND_LIGHT_FIELD_AXIS_U_BIT && !(fields & CND_LIGHT_FIELD_AXIS_V_BIT);
        const bool flat = fields & CND_LIGHT_FIELD_TWO_SIDED_BIT;
        std::mt19937_64 random(3);
        std::uniform_real_distribution<double> unit(0, 1);
        std::vector<double> differences;
        WorstCase worst, formFactor;
        int crossing = 0;
        while (static_cast<int>(differences.size()) < count) {
            const double alpha = std::pow(0.03, unit(random)); // narrower lobes are slow for the
                                                               // second integrator
            const double view = unit(random) * 89 * pi / 180;
            const SurfacePoint surface{{0, 0, 0}, {0, 0, 1}, {std::sin(view), 0, std::cos(view)}};
            const glm::dvec3 mirror(-surface.toEye.x, 0, surface.toEye.z);
            const glm::dvec3 way = unit(random) < 0.5
                                       ? unitVector(random)
                                       : glm::normalize(mirror + 0.4 * unitVector(random));
            CndLight light = makeSphere(glm::vec3((0.3 + 3 * unit(random)) * way), 0, glm::vec3(1));
            light.type = type;
            light.twoSided = unit(random) < 0.5;
            light.polygon = candelabra::app::somePolygon(uint32_t(differences.size()));
            const double size = 0.02 * std::pow(100, unit(random));
            const glm::dvec3 u = unitVector(random);
            const glm::dvec3 v = glm::normalize(glm::cross(u, unitVector(random)));
            set(light.axisU, size * u);
            set(light.axisV, size * (0.1 + unit(random)) * v);
            set(light.direction, unitVector(random));
            light.radius = static_cast<float>(alongAxis ? 0.02 * std::pow(30, unit(random)) : size);
            const glm::dvec3 center(light.position[0], light.position[1], light.position[2]);
            const double along = alongAxis ? std::clamp(-glm::dot(center, u), -size, size) : 0;
            const double radius = alongAxis ? light.radius : cndEmitterBoundingRadius(&light);
            if (!flat && glm::length(center + along * u) < 1.01 * radius)
                continue; // inside a body both use different models
            const LightResponse a = truthResponse(surface, alpha, light, glm::dvec3(0), 1e-6);
            const LightResponse b =
                emitterDomainResponse(surface, alpha, light, glm::dvec3(0), 1e-5);
            const LobeIntegral arcs = arcDomainLight(surface, alpha, light, glm::dvec3(0));
            formFactor.add(std::abs(arcs.irradiance.z - a.f), "alpha", alpha, "center", center.x,
                           center.y, center.z, "size", size, "radius", light.radius);
            if (a.f == 0 && b.f == 0)
                continue; // seen from behind or below the horizon: there is nothing to compare
            crossing += std::abs(center.z) < size;
            double difference = 0;
            for (const auto& [x, y] : {std::pair{a.a, b.a}, {a.b, b.b}, {a.f, b.f}})
                difference = std::max(difference, std::abs(x - y) / std::max({x, y, 1e-9}));
            differences.push_back(difference);
            worst.add(difference, "alpha", alpha, "center", center.x, center.y, center.z, "size",
                      size, "radius", light.radius, "NoV", surface.toEye.z);
            EXPECT_TRUE(a.converged);
        }
        std::sort(differences.begin(), differences.end());
        std::cout << "light type " << type << ", " << count << " configurations (" << crossing
                  << " near the horizon): relative difference median "
                  << differences[differences.size() / 2] << ", max " << differences.back() << "\n";
        EXPECT_TRUE(worst.within(1e-4)) << type;
        EXPECT_TRUE(formFactor.within(1e-7)) << type << ", along its outline";
    }
}

// Closed forms from Howell, A Catalog of Radiation Heat Transfer Configuration Factors, B-3, B-4
// and B-12.
TEST(ReferenceAreaTruth, formFactorsMatchTheirClosedForms)
{
    WorstCase worst;
    for (const double size : {0.01, 0.5, 3.0, 100.0}) {
        const float radius = static_cast<float>(size);
        const double r2 = double(radius) * radius;
        worst.add(std::abs(formFactor(makeDisc({0, 0, 1}, {0, 0, -1}, radius)) * (r2 + 1) / r2 - 1),
                  "disc", size);
        for (const double aspect : {1.0, 0.25}) {
            const double a = float(size), b = float(size * aspect);
            // Parallel to the surface, with one corner above it: u x v points down.
            const double x = std::sqrt(1 + a * a), y = std::sqrt(1 + b * b);
            const double parallel =
                (a / x * std::atan(b / x) + b / y * std::atan(a / y)) / (2 * pi);
            const CndLight ceiling = makeRectangle({a / 2, b / 2, 1}, {0, b / 2, 0}, {a / 2, 0, 0});
            worst.add(std::abs(formFactor(ceiling) / parallel - 1), "parallel", size, aspect);
            // A wall 1 m away, from the floor to height a, with width b to one side. Then the same
            // wall continued as far below the floor, which must not change anything.
            const double edge = std::sqrt(1 + a * a);
            const double wall = (std::atan(b) - std::atan(b / edge) / edge) / (2 * pi);
            const CndLight above = makeRectangle({1, b / 2, a / 2}, {0, 0, a / 2}, {0, b / 2, 0});
            const CndLight cut = makeRectangle({1, b / 2, 0}, {0, 0, a}, {0, b / 2, 0});
            worst.add(std::abs(formFactor(above) / wall - 1), "wall", size, aspect);
            worst.add(std::abs(formFactor(cut) / wall - 1), "wall cut by the floor", size, aspect);
        }
    }
    // An infinitely long tube: F = R / d for a receiver that faces it.
    const double tube = formFactor(makeTube({0, 0, 2}, {1e6, 0, 0}, 0.5f));
    worst.add(std::abs(tube / 0.25 - 1), "tube");
    EXPECT_TRUE(worst.within(1e-7)); // positions are floats
}

// A polygon with the corners of a rectangle, and one that is cut out of it with the pieces left
// over.
TEST(ReferenceAreaTruth, polygonsAreMadeOfTheirParts)
{
    using candelabra::app::somePolygon;
    const CndPolygon left{3, {{-1, -1}, {1, -1}, {-1, 1}}}, right{3, {{1, -1}, {1, 1}, {-1, 1}}};
    WorstCase worst;
    for (const double height : {0.4, 1.0, -0.2}) // the last one crosses the horizon
        for (const VkBool32 twoSided : {VK_FALSE, VK_TRUE})
            for (const double turn : {1.0, -1.0}) {
                CndLight light =
                    makeRectangle({-0.9, 0.3, height}, {0, 0.5 * turn, 0.5}, {1, 0, 0});
                light.twoSided = twoSided;
                const double whole = specular(light), f = formFactor(light);
                light.type = CND_LIGHT_POLYGON;
                const auto both = [&](auto&& response) {
                    light.polygon = &left;
                    const double part = response(light);
                    light.polygon = &right;
                    return part + response(light);
                };
                worst.add(std::abs(both([](const CndLight& l) { return specular(l); }) - whole),
                          "parts", height, turn);
                worst.add(std::abs(both(formFactor) - f), "parts", height, turn);
                light.polygon = somePolygon(3);
                ASSERT_EQ(light.polygon->cornerCount, 4u);
                worst.add(std::abs(specular(light) - whole), "square", height, turn);
                worst.add(std::abs(formFactor(light) - f), "square", height, turn);
            }
    EXPECT_TRUE(worst.within(1e-7));
}

TEST(ReferenceAreaTruth, degenerateShapesMeet)
{
    // A tube without length is a sphere. From beyond its end only the nearer end sphere is visible.
    const CndLight sphere = makeSphere({-1, 0.5f, 1}, 0.5f, glm::vec3(1));
    const LightResponse ball = truthResponse(upward, 0.25, sphere, glm::dvec3(0), 1e-8);
    const LightResponse shortTube =
        truthResponse(upward, 0.25, makeTube({-1, 0.5, 1}, {1e-6, 0, 0}, 0.5f), {}, 1e-8);
    EXPECT_NEAR(shortTube.a / ball.a, 1, 1e-5);
    EXPECT_NEAR(shortTube.f / ball.f, 1, 1e-5);
    const glm::dvec3 away = glm::normalize(glm::dvec3(-1, 0.5, 1));
    const LightResponse pointed = truthResponse(
        upward, 0.25, makeTube(glm::dvec3(-1, 0.5, 1) + 2.0 * away, 2.0 * away, 0.5f), {}, 1e-8);
    EXPECT_NEAR(pointed.a / ball.a, 1, 1e-6);
    // A small disc and a small square of the same area are equivalent.
    const double side = std::sqrt(pi) * 1e-3;
    const CndLight disc = makeDisc({-1, 0.5, 1}, {1, 0, -1}, 1e-3f);
    const glm::dvec3 u = side / 2 * glm::dvec3(0, 1, 0);
    const glm::dvec3 v = side / 2 * glm::normalize(glm::dvec3(1, 0, 1));
    const CndLight square = makeRectangle({-1, 0.5, 1}, u, v);
    EXPECT_GT(specular(square), 0);
    EXPECT_NEAR(specular(disc) / specular(square), 1, 1e-5);
    EXPECT_NEAR(formFactor(disc) / formFactor(square), 1, 1e-5);
}

TEST(ReferenceAreaTruth, oneSideShinesUnlessBothDo)
{
    CndLight rectangle = makeRectangle({0, 0, 1}, {0, 0.5, 0}, {0.5, 0, 0});
    CndLight disc = makeDisc({0, 0, 1}, {0, 0, -1}, 0.5f);
    for (CndLight* light : {&rectangle, &disc}) {
        const double front = formFactor(*light);
        EXPECT_GT(front, 0.1);
        for (float& x : light->axisU)
            x = -x;
        for (float& x : light->direction)
            x = -x;
        EXPECT_EQ(formFactor(*light), 0);
        EXPECT_EQ(specular(*light), 0);
        light->twoSided = VK_TRUE;
        EXPECT_NEAR(formFactor(*light), front, 1e-12);
        light->position[2] = 0; // the receiver lies in its plane
        EXPECT_EQ(formFactor(*light), 0);
        EXPECT_EQ(specular(*light), 0);
        light->position[2] = -1; // below the horizon
        EXPECT_EQ(formFactor(*light), 0);
        EXPECT_EQ(specular(*light), 0);
    }
    EXPECT_EQ(formFactor(makeTube({0, 0, -1}, {1, 0, 0}, 0.5f)), 0);
    EXPECT_EQ(specular(makeTube({0, 0, -1}, {1, 0, 0}, 0.5f)), 0);
}

// As for the sphere, the response inside a tube continues that at its surface.
TEST(ReferenceAreaTruth, tubesAreContinuousAtTheirSurface)
{
    for (const glm::dvec3& outward :
         {glm::dvec3(0, 0.6, 0.8), glm::dvec3(0.6, 0, 0.8), glm::dvec3(0, 0, -1)}) {
        // The tube lies along x; the nearest point of its segment is in the middle, or at its end.
        const double end = outward.x > 0 ? 1 : 0;
        const auto at = [&](double distance) {
            const glm::dvec3 center = distance * outward + end * glm::dvec3(1, 0, 0);
            return truthResponse(upward, 0.3, makeTube({0, 0, 0}, {1, 0, 0}, 1), center, 1e-7);
        };
        const LightResponse outside = at(1 + 1e-6), inside = at(1 - 1e-6);
        EXPECT_NEAR(outside.f, (1 + outward.z) / 2, 2e-3) << outward.x;
        EXPECT_NEAR(outside.f, inside.f, 2e-3) << outward.x;
        EXPECT_NEAR(outside.a, inside.a, 2e-3) << outward.x;
    }
}

} // namespace candelabra::test
