// SPDX-License-Identifier: Apache-2.0
// Tests the viewer's camera.
#include <cmath>

#include <gtest/gtest.h>

#include "viewer/fly_camera.h"
#include "viewer/selection.h"

using namespace candelabra::app;

namespace
{

Camera looking(const glm::dvec3& forward)
{
    Camera camera;
    camera.position = {1, 2, 3};
    camera.forward = glm::normalize(forward);
    camera.aspect = 2.0;
    camera.verticalFov = 0.7;
    return camera;
}

void expectNear(const glm::dvec3& a, const glm::dvec3& b)
{
    EXPECT_LT(glm::length(a - b), 1e-9)
        << a.x << " " << a.y << " " << a.z << " against " << b.x << " " << b.y << " " << b.z;
}

} // namespace

TEST(FlyCamera, StartsWhereTheSceneCameraIs)
{
    for (const glm::dvec3 f : {glm::dvec3(0, 0, -1), {1, 0, 0}, {-1, 0.5, 2}, {0.2, -0.9, 0.1}}) {
        const Camera start = looking(f);
        const Camera now = FlyCamera(start, 1).camera();
        expectNear(now.position, start.position);
        expectNear(now.forward, start.forward);
        EXPECT_EQ(now.verticalFov, start.verticalFov);
        EXPECT_EQ(now.aspect, start.aspect); // the window shows all that the camera frames
    }
}

TEST(FlyCamera, LookingStraightDownStaysUsable)
{
    const Camera now = FlyCamera(looking({0, -1, 0}), 1).camera();
    EXPECT_GT(glm::length(glm::cross(now.forward, now.up)), 1e-3);
}

TEST(FlyCamera, MovesAlongItsAxes)
{
    FlyCamera camera(looking({1, 0, 0}), 2);
    camera.update({.move = {0, 0, 1}}, 0.5);
    expectNear(camera.camera().position, {2, 2, 3}); // forward is +x
    camera.update({.move = {1, 0, 0}}, 0.5);
    expectNear(camera.camera().position, {2, 2, 4}); // right of +x is +z
    camera.update({.move = {0, 1, 0}, .fast = true}, 0.5);
    EXPECT_GT(camera.camera().position.y, 4);
}

TEST(FlyCamera, LooksRightAndDownWithTheMouse)
{
    FlyCamera camera(looking({0, 0, -1}), 1);
    camera.update({.look = {10, 10}}, 0.1);
    EXPECT_GT(camera.camera().forward.x, 0);
    EXPECT_LT(camera.camera().forward.y, 0);
    camera.update({.look = {0, -1e9}}, 0.1); // the view stops short of straight up
    EXPECT_GT(camera.camera().forward.y, 0.99);
    EXPECT_GT(glm::length(glm::cross(camera.camera().forward, glm::dvec3(0, 1, 0))), 1e-3);
}

TEST(FlyCamera, WheelScalesSpeedWithinBounds)
{
    FlyCamera camera(looking({0, 0, -1}), 1);
    camera.wheel(2);
    EXPECT_NEAR(camera.speed(), 1.25 * 1.25, 1e-12);
    camera.wheel(-1e6);
    EXPECT_GT(camera.speed(), 0);
    camera.wheel(1e6);
    EXPECT_TRUE(std::isfinite(camera.speed()));
}

TEST(FlyCamera, OrbitKeepsThePointInTheMiddle)
{
    FlyCamera camera(looking({0, 0, -1}), 1);
    camera.orbit(4);
    const glm::dvec3 pivot = camera.camera().position + 4.0 * camera.camera().forward;
    camera.update({.look = {300, -100}}, 0.1);
    expectNear(camera.camera().position + 4.0 * camera.camera().forward, pivot);
    camera.wheel(1); // moves nearer to the pivot
    expectNear(camera.camera().position + 4 / 1.25 * camera.camera().forward, pivot);
    camera.update({.move = {0, 0, 1}}, 0.2); // so does moving forward, but never through the pivot
    expectNear(camera.camera().position + (4 / 1.25 - 0.2) * camera.camera().forward, pivot);
    camera.update({.move = {0, 0, 1}}, 1e6);
    EXPECT_GT(glm::dot(pivot - camera.camera().position, camera.camera().forward), 0);
    const glm::dvec3 place = camera.camera().position;
    camera.fly();
    camera.update({.look = {50, 0}}, 0.1);
    expectNear(camera.camera().position, place);
}

// A camera that is fitted to something behind a wall comes before the wall.
TEST(BeforeOccluders, StandsWhereNothingHidesTheFront)
{
    Scene scene;
    scene.materials.emplace_back();
    scene.analyticObjects.push_back({.type = AnalyticObject::Type::Ball, .point = {0, 0, 5}});
    RayCaster rays(scene);
    Camera camera;
    camera.position = {0, 0, 20};
    const Camera before = beforeOccluders(camera, {0, 0, 1}, rays);
    EXPECT_GT(before.position.z, 1 + before.nearPlane);
    EXPECT_LT(before.position.z, 4); // where the ball begins
    EXPECT_EQ(before.forward, camera.forward);
    camera.position = {0, 0, 3.5}; // before the ball
    EXPECT_EQ(beforeOccluders(camera, {0, 0, 1}, rays), camera);
    EXPECT_EQ(beforeOccluders(camera, {9, 0, 1}, rays), camera); // nothing hides it
    // The front may be on a surface, here that of the ball.
    camera.position = {0, 0, 20};
    EXPECT_EQ(beforeOccluders(camera, {0, 0, 6}, rays), camera);
}
