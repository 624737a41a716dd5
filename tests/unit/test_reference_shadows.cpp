// SPDX-License-Identifier: Apache-2.0
// Tests visible light: the tree of triangles against all triangles one by one, lights whose visible
// part is a light of its own, complementary occluders, and pixels that another program integrated.
#include <algorithm>
#include <cmath>
#include <iostream>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "data/box_shadow.h"
#include "harness/constants.h"
#include "harness/full_tests.h"
#include "reference/emitter_points.h"
#include "reference/render.h"
#include "reference/truth.h"
#include "reference/visibility.h"
#include "scene/polygons.h"
#include "test_reference_support.h"

namespace candelabra::test
{

using namespace candelabra::reference;

namespace
{

using Triangles = std::vector<Triangle>;

void addTriangle(Triangles& out, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c)
{
    const glm::dvec3 normal = glm::normalize(glm::cross(b - a, c - a));
    out.push_back({.corners = {a, b, c}, .normals = {normal, normal, normal}});
}

void addQuad(Triangles& out, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c,
             const glm::dvec3& d)
{
    addTriangle(out, a, b, c);
    addTriangle(out, a, c, d);
}

void addBox(Triangles& out, const glm::dvec3& low, const glm::dvec3& high)
{
    const auto corner = [&](int i) {
        return glm::dvec3(i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z);
    };
    for (const auto& [a, b, c, d] :
         {std::array{0, 4, 6, 2}, std::array{1, 3, 7, 5}, std::array{0, 1, 5, 4},
          std::array{2, 6, 7, 3}, std::array{0, 2, 3, 1}, std::array{4, 5, 7, 6}})
        addQuad(out, corner(a), corner(b), corner(c), corner(d));
}

// A point on the ground that looks into the mirror direction of `toLight`.
SurfacePoint mirroring(const glm::dvec3& toLight)
{
    const glm::dvec3 l = glm::normalize(toLight);
    return {{0, 0, 0}, {0, 0, 1}, {-l.x, -l.y, l.z}};
}

Material glossy(double alpha)
{
    return {.diffuseAlbedo = glm::dvec3(0.5, 0.3, 0.1),
            .f0 = glm::dvec3(0.04),
            .specularWeight = 1,
            .alpha = alpha};
}

glm::dvec3 visibleLight(const SurfacePoint& surface, const Material& material,
                        const CndLight& light, const Triangles& triangles,
                        uint32_t ignoredLayers = 0, uint64_t seed = 0)
{
    const Occluders occluders({}, triangles);
    glm::dvec3 pixel(0);
    addLights({.lights = {&light, 1},
               .ignoredLayers = {&ignoredLayers, 1},
               .occluders = &occluders,
               .seed = seed},
              surface, material, pixel);
    return pixel;
}

double difference(const glm::dvec3& a, const glm::dvec3& b)
{
    return glm::length(a - b) / glm::length(b);
}

// Lights of every area type around `center`. Their radii or half sides are at most 0.35 of their
// distance.
std::vector<CndLight> lightsAround(const glm::dvec3& center)
{
    const double reach = 0.35 * glm::length(center);
    const glm::dvec3 u = glm::normalize(glm::cross(center, {0.3, 1, 0.2}));
    const glm::dvec3 v = glm::normalize(glm::cross(u, center));
    std::vector<CndLight> out = {makeSphere(glm::vec3(center), float(reach), glm::vec3(1)),
                                 makeRectangle(center, reach * u, 0.6 * reach * v),
                                 makeDisc(center, -center, float(reach)),
                                 makeTube(center, reach * u, float(0.1 * reach)),
                                 makeTube(center, 0.7 * reach * glm::normalize(center), 0.3f)};
    out.push_back(makeSphere({}, 0.2f, glm::vec3(1)));
    out.back().type = CND_LIGHT_DISTANT_SPHERE;
    set(out.back().direction, -center);
    out.push_back(makeRectangle(center, reach * u, reach * v));
    out.back().type = CND_LIGHT_POLYGON;
    static const CndPolygon triangle{.cornerCount = 3, .corners = {{-1, -1}, {1, -0.8f}, {0, 1}}};
    out.back().polygon = &triangle;
    for (CndLight& light : out)
        light.twoSided = VK_TRUE;
    return out;
}

} // namespace

TEST(ReferenceOccluders, TreeFindsWhatAllTrianglesFind)
{
    std::mt19937_64 random(4);
    std::uniform_real_distribution<double> unit(-1, 1);
    const auto point = [&] { return glm::dvec3(unit(random), unit(random), unit(random)); };
    Triangles triangles;
    for (int i = 0; i < 400; ++i) {
        const glm::dvec3 a = 3.0 * point();
        addTriangle(triangles, a, a + point(), a + point());
        triangles.back().occluderLayer = i % 3;
    }
    const Occluders tree({}, triangles);
    std::vector<uint32_t> all(triangles.size()), found;
    for (uint32_t i = 0; i < all.size(); ++i)
        all[i] = i;
    size_t stopped = 0, listed = 0;
    for (int i = 0; i < 20000; ++i) {
        const glm::dvec3 from = 4.0 * point(), way = 8.0 * point();
        const LightRay ray{.origin = from, .direction = way, .ignoredLayers = uint32_t(i % 8)};
        const bool expected = tree.stop(ray, all);
        ASSERT_EQ(tree.stop(ray), expected) << i;
        stopped += expected;
        // A shaft around the ray finds everything that stops it.
        if (tree.collect(Shaft(from, way, 0.3), ray.ignoredLayers, 400, found)) {
            ASSERT_EQ(tree.stop(ray, found), expected) << i;
            listed += found.size();
        }
    }
    std::cout << stopped << " of 20000 rays are stopped; " << double(listed) / 20000
              << " triangles are in a shaft\n";
    EXPECT_GT(stopped, 3000u);
    EXPECT_LT(listed, 20000u * 100);
}

TEST(ReferenceOccluders, NearestHitIsTheFirstVisibleSide)
{
    Triangles triangles;
    addQuad(triangles, {-1, -1, 1}, {-1, 1, 1}, {1, 1, 1}, {1, -1, 1}); // faces down
    addQuad(triangles, {-1, -1, 2}, {1, -1, 2}, {1, 1, 2}, {-1, 1, 2}); // faces up
    const Ray ray{{0.2, 0.1, 3}, {0, 0, -2}};
    EXPECT_EQ(Occluders({}, triangles).nearest(ray)->distance, 0.5);
    triangles.resize(2);
    EXPECT_FALSE(Occluders({}, triangles).nearest(ray));
    triangles[0].twoSided = triangles[1].twoSided = true;
    EXPECT_EQ(Occluders({}, triangles).nearest(ray)->distance, 1);
    EXPECT_FALSE(Occluders({}, {}).nearest(ray));
}

// A surface does not shadow itself, whatever triangles it consists of; what is drawn at an emitter
// does not hide it.
TEST(ReferenceShadows, LightThatNothingHidesKeepsItsBits)
{
    Triangles triangles;
    addQuad(triangles, {-9, -9, 0}, {9, -9, 0}, {9, 9, 0}, {-9, 9, 0});
    addQuad(triangles, {-9, -9, 0}, {9, -9, 0}, {9, 9, 0}, {-9, 9, 0});
    addBox(triangles, {-3, 1, 0}, {-2, 2, 3});
    addQuad(triangles, {0.5, -0.5, 2}, {1.5, -0.5, 2}, {1.5, 0.5, 2}, {0.5, 0.5, 2});
    const CndLight light = makeRectangle({1, 0, 2}, {0, 0.5, 0}, {0.5, 0, 0});
    const SurfacePoint surface = mirroring({1, 0, 2});
    EXPECT_EQ(visibleLight(surface, glossy(0.1), light, triangles),
              truthLuminance(surface, glossy(0.1), light, glm::dvec3(0), 1e-4).luminance);
}

TEST(ReferenceShadows, HiddenLightAddsNothingUnlessItIgnoresTheLayer)
{
    Triangles triangles;
    addBox(triangles, {-3, -3, 0.5}, {4, 3, 0.6});
    for (Triangle& triangle : triangles)
        triangle.occluderLayer = 5;
    for (CndLight& light : lightsAround({1, 0.3, 2})) {
        const SurfacePoint surface = mirroring({1, 0.3, 2});
        EXPECT_EQ(visibleLight(surface, glossy(0.1), light, triangles), glm::dvec3(0));
        EXPECT_EQ(visibleLight(surface, glossy(0.1), light, triangles, 1u << 5),
                  truthLuminance(surface, glossy(0.1), light, glm::dvec3(0), 1e-4).luminance);
    }
    CndLight point = makeSphere({1, 0.3, 2}, 0, glm::vec3(1));
    point.type = CND_LIGHT_POINT;
    EXPECT_EQ(visibleLight(mirroring({1, 0, 2}), glossy(0.1), point, triangles), glm::dvec3(0));
    EXPECT_GT(visibleLight(mirroring({1, 0, 2}), glossy(0.1), point, {}).x, 0);
}

// What a wall leaves of a rectangle is a rectangle, whose truth is known without any visibility.
TEST(ReferenceShadows, PartOfARectangleIsARectangle)
{
    WorstCase worst;
    for (const double alpha : {0.02, 0.1, 0.4, 1.0})
        for (const double cut : {-0.4, -0.05, 0.3})
            for (const double height : {0.4, 2.0}) {
                const CndLight light = makeRectangle({0, 1, height}, {0, 0.5, 0}, {0.5, 0, 0});
                const CndLight part = makeRectangle({(cut - 0.5) / 2, 1, height}, {0, 0.5, 0},
                                                    {(cut + 0.5) / 2, 0, 0});
                // A wall half way up hides all points of the light with x > cut.
                Triangles wall;
                addQuad(wall, {cut / 2, -9, height / 2}, {9, -9, height / 2}, {9, 9, height / 2},
                        {cut / 2, 9, height / 2});
                const SurfacePoint surface = mirroring({-0.1, 1, height});
                const glm::dvec3 expected =
                    truthLuminance(surface, glossy(alpha), part, glm::dvec3(0), 1e-6).luminance;
                worst.add(difference(visibleLight(surface, glossy(alpha), light, wall), expected),
                          alpha, cut, height);
            }
    EXPECT_TRUE(worst.within(2e-3));
}

// Two walls without a gap hide a light together, so what each leaves adds up to the whole.
TEST(ReferenceShadows, ComplementaryWallsShareTheLight)
{
    WorstCase worst;
    double sum = 0;
    int lights = 0;
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> unit(-1, 1);
    const int count = fullTests() ? 40 : 2;
    for (int i = 0; i < count; ++i) {
        const double alpha = std::pow(0.02, 0.5 + 0.5 * unit(random));
        const glm::dvec3 center(0.5 * unit(random), 2 + 0.5 * unit(random),
                                1.4 + 0.8 * unit(random));
        const double edge = 0.02 * unit(random);
        Triangles left, right;
        const glm::dvec3 middle = 0.1 * center + glm::dvec3(edge, 0, 0);
        const glm::dvec3 tilt(unit(random), 0, 9);
        addQuad(left, middle - tilt, middle + tilt, middle + tilt - glm::dvec3(9, 0, 0),
                middle - tilt - glm::dvec3(9, 0, 0));
        addQuad(right, middle - tilt, middle + tilt, middle + tilt + glm::dvec3(9, 0, 0),
                middle - tilt + glm::dvec3(9, 0, 0));
        for (const CndLight& light : lightsAround(center)) {
            const SurfacePoint surface =
                mirroring(center + 0.3 * glm::dvec3(unit(random), 0, unit(random)));
            const glm::dvec3 whole =
                truthLuminance(surface, glossy(alpha), light, glm::dvec3(0), 1e-4).luminance;
            const double error =
                difference(visibleLight(surface, glossy(alpha), light, left, 0, 1) +
                               visibleLight(surface, glossy(alpha), light, right, 0, 2),
                           whole);
            worst.add(error, light.type, alpha, i);
            sum += error;
            ++lights;
        }
    }
    std::cout << lights << " lights, mean difference " << sum / lights << '\n';
    EXPECT_TRUE(worst.within(5e-3));
    EXPECT_LT(sum / lights, 6e-4);
}

// Points of an emitter and their densities: the solid angle that they say is the emitter's own.
TEST(ReferenceShadows, PointsOfEmittersHaveTheirDensity)
{
    std::mt19937_64 random(9);
    std::uniform_real_distribution<double> unit(0, 1);
    for (const CndLight& light : lightsAround({0.2, 0.4, 2})) {
        const EmitterPoints points(light, glm::dvec3(0), glm::dvec3(0));
        double factor = 0;
        constexpr int count = 40000;
        for (int i = 0; i < count; ++i) {
            const double u = unit(random);
            const EmitterPoint point = points.at(u, unit(random));
            if (!(point.density > 0))
                continue;
            factor += std::max(point.direction.z, 0.0) / point.density / count / pi;
            const auto again = points.along(point.direction);
            if (!again)
                continue; // rounding at the outline
            EXPECT_NEAR(again->density / point.density, 1, 1e-6) << light.type;
            if (std::isfinite(point.distance)) {
                EXPECT_NEAR(again->distance / point.distance, 1, 1e-6) << light.type;
            }
        }
        const double expected =
            truthResponse({{0, 0, 0}, {0, 0, 1}, {0, 0, 1}}, 0, light, glm::dvec3(0), 1e-6).f;
        EXPECT_NEAR(factor / expected, 1, 0.02) << light.type;
    }
}

// Balls and planes hide light like triangles; receivers on them are not shadowed by them.
TEST(ReferenceShadows, BallsAndPlanesHideLight)
{
    const std::vector<Object> objects = {
        {}, {.type = Object::Type::Ball, .point = {0, 1, 0}, .radius = 0.5}};
    const Occluders occluders(objects, {});
    CndLight sun{};
    sun.type = CND_LIGHT_DIRECTIONAL;
    set(sun.direction, {0, -1, 0});
    set(sun.emission, {1, 1, 1});
    const auto lit = [&](const glm::dvec3& position, const glm::dvec3& normal) {
        glm::dvec3 pixel(0);
        addLights({.lights = {&sun, 1}, .occluders = &occluders}, {position, normal, normal},
                  glossy(1), pixel);
        return pixel.x > 0;
    };
    EXPECT_FALSE(lit({0.49, 0, 0}, {0, 1, 0}));
    EXPECT_TRUE(lit({0.51, 0, 0}, {0, 1, 0}));
    EXPECT_TRUE(lit({0, 1.5, 0}, {0, 1, 0}));
    EXPECT_FALSE(lit({0.51, -1, 0}, {0, 1, 0})); // below the plane
}

// Pixels of a box on the ground under a sphere and a rectangle, integrated by a program that shares
// nothing with this one (box_shadow.h).
TEST(ReferenceShadows, PixelsAgreeWithAnotherProgram)
{
    Scene scene;
    scene.camera = {
        boxShadowEye, boxShadowTarget - boxShadowEye, {0, 1, 0}, 50 * pi / 180, 4.0 / 3};
    scene.materials = {{.diffuseAlbedo = {0.5, 0.4, 0.3},
                        .f0 = glm::dvec3(0.04),
                        .specularWeight = 1,
                        .alpha = 0.15}};
    addQuad(scene.triangles, {-99, 0, 99}, {99, 0, 99}, {99, 0, -99}, {-99, 0, -99});
    addBox(scene.triangles, {-0.4, 0, -0.3}, {0.5, 0.7, 0.4});
    scene.lights = {makeSphere({1.3f, 1.9f, 0.4f}, 0.25f, {10, 8, 6}),
                    makeRectangle({-1.1, 1.5, 0.6}, {0.5, 0.1, 0}, {0.1, 0.2, 0.4})};
    set(scene.lights[1].emission, {2, 3, 5});
    WorstCase worst;
    double sum = 0;
    for (const BoxShadowPixel& pixel : boxShadow) {
        const std::array<uint32_t, 1> rows = {pixel.row};
        const TruthRows truth = renderTruth(
            scene, 64, 48, rows, {.shadows = true, .wanted = [&](uint32_t column, uint32_t) {
                                      return column == pixel.column;
                                  }});
        EXPECT_TRUE(std::isnan(truth.pixels[pixel.column == 0 ? 1 : 0].x));
        const double error = difference(truth.pixels[pixel.column], pixel.luminance);
        worst.add(error, pixel.column, pixel.row);
        sum += error;
    }
    std::cout << "mean difference " << sum / std::size(boxShadow) << '\n';
    EXPECT_TRUE(worst.within(2e-3));
    EXPECT_LT(sum / std::size(boxShadow), 5e-4);
}

} // namespace candelabra::test
