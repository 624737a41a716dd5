// SPDX-License-Identifier: Apache-2.0
// Tests scene queries: bounds, rays, positions of moving lights.
#include <cmath>

#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "generate/generators.h"
#include "generate/light_grid.h"
#include "generate/random.h"
#include "generate/ray_caster.h"
#include "generate/shapes.h"
#include "scene/scene_error.h"
#include "scene/scene_options.h"
#include "unit/scene_invariants.h"

namespace candelabra::app
{
namespace
{

Scene sceneOf(Mesh mesh, const glm::dmat4& worldFromObject)
{
    Scene scene;
    scene.meshes.push_back(std::move(mesh));
    scene.materials.resize(1);
    scene.instances.push_back({0, 0, worldFromObject});
    return scene;
}

TEST(SceneBounds, CoverAllInstances)
{
    EXPECT_EQ(sceneBounds({}).max, glm::dvec3(0));
    Scene scene = sceneOf(makeBox(), glm::translate(glm::dmat4(1), {1e7, 2, 3}));
    scene.meshes.emplace_back(); // a mesh without vertices does not extend the bounds
    scene.instances.push_back({1, 0, glm::dmat4(1)});
    Bounds bounds = sceneBounds(scene);
    EXPECT_EQ(bounds.min, glm::dvec3(1e7 - 0.5, 1.5, 2.5));
    EXPECT_EQ(bounds.max, glm::dvec3(1e7 + 0.5, 2.5, 3.5));
    // Turned by 45 degrees and doubled: half the diagonal is sqrt(2).
    scene.instances[0].worldFromObject =
        glm::scale(glm::rotate(glm::dmat4(1), glm::radians(45.0), {0, 1, 0}), glm::dvec3(2));
    bounds = sceneBounds(scene);
    EXPECT_NEAR(bounds.max.x, std::sqrt(2.0), 1e-12);
    EXPECT_NEAR(bounds.max.y, 1, 1e-12);
    EXPECT_NEAR(bounds.min.z, -std::sqrt(2.0), 1e-12);
}

TEST(LightsAtTime, FollowTheirCircles)
{
    Scene scene;
    CndLight light{};
    light.position[0] = 5;
    scene.lights = {light, light};
    std::vector<CndLight> out;
    lightsAtTime(scene, 3, out);
    ASSERT_EQ(out.size(), 2u);
    EXPECT_EQ(out[1].position[0], 5);

    scene.lightMotions.resize(2);
    scene.lightMotions[1] = {{2, 0, 0}, {0, 0, 2}, glm::pi<float>(), 0};
    lightsAtTime(scene, 0.5, out); // a quarter turn
    EXPECT_EQ(out[0].position[0], 5);
    EXPECT_NEAR(out[1].position[0], 5, 1e-6);
    EXPECT_NEAR(out[1].position[2], 2, 1e-6);
    // After a day the light is still on the circle, and where it should be.
    lightsAtTime(scene, 86400.5, out);
    EXPECT_NEAR(std::hypot(out[1].position[0] - 5, out[1].position[2]), 2, 1e-5);
    const double angle = static_cast<double>(glm::pi<float>()) * 86400.5;
    EXPECT_NEAR(out[1].position[2], 2 * std::sin(angle), 1e-5);
}

TEST(LightsAtTime, AnyTypeMovesUnlessItIsInfinitelyFarAway)
{
    SceneOptions options;
    options.moving = true;
    const Scene scene = generateShowcase(options);
    EXPECT_EQ(test::brokenInvariant(scene), "");
    uint32_t types = 0;
    for (const CndLight& light : scene.lights)
        types |= 1u << light.type;
    EXPECT_EQ(types, (1u << CND_LIGHT_TYPE_COUNT) - 1); // one of every type
    std::vector<CndLight> out;
    lightsAtTime(scene, 2, out);
    ASSERT_EQ(out.size(), scene.lights.size());
    for (size_t i = 0; i < out.size(); ++i) {
        const bool distant =
            out[i].type == CND_LIGHT_DIRECTIONAL || out[i].type == CND_LIGHT_DISTANT_SPHERE;
        const bool moved = out[i].position[0] != scene.lights[i].position[0];
        EXPECT_EQ(moved, !distant) << out[i].type;
    }
    options.lights = 3;
    EXPECT_THROW(generateShowcase(options), SceneError);
}

TEST(RayCaster, FindsTheNearestTriangle)
{
    Scene scene = sceneOf(makeBox(), glm::translate(glm::dmat4(1), {0, 0, -5}));
    scene.instances.push_back({0, 0, glm::translate(glm::dmat4(1), {0, 0, -9})});
    // flat, so it is left out
    scene.instances.push_back({0, 0, glm::scale(glm::dmat4(1), {1, 0, 1})});
    RayCaster caster(scene);
    const auto hit = caster.cast({{0.1, 0.2, 0}, {0, 0, -1}});
    ASSERT_TRUE(hit);
    EXPECT_NEAR(hit->distance, 4.5, 1e-9);
    EXPECT_NEAR(hit->normal.z, 1, 1e-9);
    EXPECT_FALSE(caster.cast({{0.1, 0.7, 0}, {0, 0, -1}}));
    EXPECT_FALSE(caster.cast({{0, 0, 0}, {0, 0, 1}}));
    // For a ray from inside, the normal faces the ray.
    const auto inside = caster.cast({{0, 0, -5}, {0, 1, 0}});
    ASSERT_TRUE(inside);
    EXPECT_NEAR(inside->normal.y, -1, 1e-9);
}

TEST(RayCaster, AgreesWithTheSphereItApproximates)
{
    // Scaled and far from the origin, so that every coordinate space matters.
    const glm::dvec3 centre{1000, -50, 300};
    const Scene scene = sceneOf(makeSphere(128, 64),
                                glm::scale(glm::translate(glm::dmat4(1), centre), glm::dvec3(3)));
    Scene exact;
    exact.analyticObjects.push_back({.type = AnalyticObject::Type::Ball, .point = centre});
    exact.analyticObjects[0].radius = 3;
    RayCaster meshed(scene), analytic(exact);
    Random random(5);
    int hits = 0;
    for (int i = 0; i < 500; ++i) {
        const glm::dvec3 from = centre + 20.0 * (glm::dvec3(random.uniform3()) - 0.5);
        const glm::dvec3 to = centre + 5.0 * (glm::dvec3(random.uniform3()) - 0.5);
        if (glm::length(from - centre) < 3.1) {
            continue;
        }
        const Ray ray{from, glm::normalize(to - from)};
        const auto a = meshed.cast(ray), b = analytic.cast(ray);
        if (a && b && glm::dot(b->normal, ray.direction) < -0.3) {
            ++hits;
            EXPECT_NEAR(a->distance, b->distance, 0.02);
            EXPECT_GT(glm::dot(a->normal, b->normal), 0.999);
        }
    }
    EXPECT_GT(hits, 200);
}

TEST(RayCaster, SeesPlanesFromAboveOnly)
{
    Scene scene;
    scene.analyticObjects.push_back({.point = {0, 1, 0}});
    RayCaster caster(scene);
    const auto hit = caster.cast({{0, 3, 0}, glm::normalize(glm::dvec3(0, -1, 1))});
    ASSERT_TRUE(hit);
    EXPECT_NEAR(hit->position.z, 2, 1e-12);
    EXPECT_FALSE(caster.cast({{0, 0, 0}, {0, 1, 0}}));
    EXPECT_FALSE(caster.cast({{0, 3, 0}, {0, 1, 0}}));
}

TEST(CameraRay, GoesThroughPixelCentres)
{
    Camera camera{.position = {1, 2, 3}};
    camera.verticalFov = glm::radians(90.0);
    // The middle pixel of an image with odd sides looks along `forward`.
    EXPECT_NEAR(cameraRay(camera, 1, 1, 3, 3).direction.z, -1, 1e-15);
    const glm::dvec3 corner = cameraRay(camera, 0, 0, 4, 2).direction;
    EXPECT_NEAR(corner.x / corner.z, 1.5, 1e-12);  // left
    EXPECT_NEAR(corner.y / corner.z, -0.5, 1e-12); // up
    camera.orthographic = true;
    camera.orthographicHeight = 8;
    const Ray parallel = cameraRay(camera, 3, 1, 4, 2);
    EXPECT_EQ(parallel.direction, camera.forward);
    EXPECT_NEAR(parallel.origin.x, 1 + 6, 1e-12);
    EXPECT_NEAR(parallel.origin.y, 2 - 2, 1e-12);
}

TEST(LightGrid, FindsEveryNeighbour)
{
    Random random(11);
    for (const glm::dvec3& size :
         {glm::dvec3(10, 10, 10), glm::dvec3(1000, 0, 300), glm::dvec3(0)}) {
        std::vector<glm::dvec3> points;
        for (int i = 0; i < 500; ++i) {
            points.push_back(size * glm::dvec3(random.uniform3()));
        }
        const LightGrid grid(points);
        for (int i = 0; i < 50; ++i) {
            const glm::dvec3 centre = size * (2.0 * glm::dvec3(random.uniform3()) - 0.5);
            const double radius = 0.3 * glm::length(size) * random.uniform();
            std::vector<int> visits(points.size(), 0);
            grid.visit(centre, radius, [&](uint32_t index) { ++visits[index]; });
            for (size_t k = 0; k < points.size(); ++k) {
                ASSERT_LE(visits[k], 1);
                if (glm::length(points[k] - centre) <= radius) {
                    ASSERT_EQ(visits[k], 1);
                }
            }
        }
    }
}

} // namespace
} // namespace candelabra::app
