// SPDX-License-Identifier: Apache-2.0
// Tests the program's camera: pinhole convention, reversed depth, and invalid input.
#include <cmath>

#include <gtest/gtest.h>

#include "io/error.h"
#include "render/camera.h"

using namespace candelabra::app;

namespace
{

// Returns the clip coordinates of a world point, computed in double precision.
glm::dvec4 project(const CndCamera& camera, const glm::dvec3& world)
{
    glm::dmat4 view, clip;
    for (int i = 0; i < 16; ++i) {
        view[i / 4][i % 4] = camera.viewFromWorld[i];
        clip[i / 4][i % 4] = double(camera.clipFromView[i]);
    }
    return clip * (view * glm::dvec4(world, 1));
}

Camera oblique()
{
    Camera camera;
    camera.position = {3, 2, 5};
    camera.forward = glm::normalize(glm::dvec3(-1, -0.4, -2));
    camera.verticalFov = 0.8;
    camera.nearPlane = 0.1;
    return camera;
}

// Returns a point at `distance` along the ray through pixel (i, j) of a w x h image, by the pinhole
// formula direction = forward + tan(fov/2) (x aspect right + y up').
glm::dvec3 onPixelRay(const Camera& c, double i, double j, double w, double h, double distance)
{
    const double x = 2 * (i + 0.5) / w - 1, y = 1 - 2 * (j + 0.5) / h;
    const glm::dvec3 right = glm::normalize(glm::cross(c.forward, c.up));
    const glm::dvec3 up = glm::cross(right, c.forward);
    const double t = std::tan(c.verticalFov / 2);
    return c.position + distance * (c.forward + t * (x * w / h * right + y * up));
}

} // namespace

TEST(Camera, PixelCentresProjectToPixelCentres)
{
    const Camera camera = oblique();
    const CndCamera matrices = makeCamera(camera, 640.0 / 360);
    for (const auto& [i, j] : {std::pair{0, 0}, {639, 0}, {0, 359}, {320, 180}, {77, 301}}) {
        const glm::dvec4 clip = project(matrices, onPixelRay(camera, i, j, 640, 360, 7));
        // Vulkan: framebuffer x = (x_ndc + 1) / 2 * width, y likewise from the top.
        EXPECT_NEAR((clip.x / clip.w + 1) / 2 * 640, i + 0.5, 1e-3);
        EXPECT_NEAR((clip.y / clip.w + 1) / 2 * 360, j + 0.5, 1e-3);
        EXPECT_NEAR(clip.z / clip.w, 0.1 / 7, 1e-7); // reversed infinite: near / distance
    }
}

TEST(Camera, FiniteAndOrthographicDepthRunFromOneToZero)
{
    Camera camera = oblique();
    camera.farPlane = 50;
    for (const bool orthographic : {false, true}) {
        camera.orthographic = orthographic;
        camera.orthographicHeight = 4;
        const CndCamera matrices = makeCamera(camera, 1.5);
        for (const auto& [distance, depth] : {std::pair{0.1, 1.0}, {50.0, 0.0}}) {
            const glm::dvec4 clip = project(matrices, camera.position + distance * camera.forward);
            EXPECT_NEAR(clip.z / clip.w, depth, 1e-6) << "orthographic " << orthographic;
        }
    }
}

TEST(Camera, OrthographicHeightSpansTheImage)
{
    Camera camera; // at the origin, looking down -z
    camera.orthographic = true;
    camera.orthographicHeight = 4;
    camera.farPlane = 10;
    const glm::dvec4 clip = project(makeCamera(camera, 2), {4, 2, -1});
    EXPECT_NEAR(clip.x / clip.w, 1, 1e-6);
    EXPECT_NEAR(clip.y / clip.w, -1, 1e-6); // the top of the image
}

// A picture with another aspect than the camera's shows all that the camera frames, unstretched.
TEST(Camera, PicturesWithAnotherAspectAreNeitherStretchedNorCut)
{
    for (const bool orthographic : {false, true})
        for (const double own : {0.5, 1.0, 3.0}) {
            Camera camera;
            camera.orthographic = orthographic;
            camera.orthographicHeight = 4;
            camera.farPlane = 10;
            const CndCamera without = makeCamera(camera, own);
            camera.aspect = own;
            const CndCamera matrices = makeCamera(camera, 1.5);
            EXPECT_FLOAT_EQ(-matrices.clipFromView[5], 1.5f * matrices.clipFromView[0]);
            const float across = matrices.clipFromView[0] / without.clipFromView[0];
            const float along = matrices.clipFromView[5] / without.clipFromView[5];
            EXPECT_FLOAT_EQ(std::max(across, along), 1); // as large as the picture allows
        }
}

TEST(Camera, FarFromTheOriginNothingIsLost)
{
    Camera camera = oblique();
    camera.position += glm::dvec3(1e7, 0, -1e7);
    const glm::dvec3 point = onPixelRay(camera, 100, 50, 640, 360, 3);
    const glm::dvec4 clip = project(makeCamera(camera, 640.0 / 360), point);
    EXPECT_NEAR((clip.x / clip.w + 1) / 2 * 640, 100.5, 1e-3);
}

TEST(Camera, ImpossibleCamerasAreRefusedByName)
{
    const auto refuse = [](auto change, const char* word) {
        Camera camera;
        camera.name = "odd";
        change(camera);
        try {
            makeCamera(camera, 1);
            ADD_FAILURE() << "accepted: " << word;
        } catch (const UsageError& error) {
            EXPECT_NE(std::string(error.what()).find("odd"), std::string::npos) << error.what();
            EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
        }
    };
    refuse([](Camera& c) { c.up = c.forward; }, "up");
    refuse([](Camera& c) { c.position.x = NAN; }, "position");
    refuse([](Camera& c) { c.verticalFov = 4; }, "field of view");
    refuse([](Camera& c) { c.nearPlane = 0; }, "near");
    refuse([](Camera& c) { c.farPlane = 0.01; }, "far");
    refuse([](Camera& c) { c.aspect = 0.0; }, "aspect");
    refuse([](Camera& c) { c.orthographic = true; }, "orthographic");
}

TEST(Camera, SelectionByNameIndexAndNumbers)
{
    Scene scene;
    scene.cameras.resize(2);
    scene.cameras[0].name = "door";
    scene.cameras[1].name = "balcony";
    EXPECT_EQ(selectCamera(scene, "").name, "door");
    EXPECT_EQ(selectCamera(scene, "balcony").name, "balcony");
    EXPECT_EQ(selectCamera(scene, "1").name, "balcony");
    const Camera typed = selectCamera(scene, "1,2,3,1,2,-7,60");
    EXPECT_EQ(typed.position, glm::dvec3(1, 2, 3));
    EXPECT_EQ(typed.forward, glm::dvec3(0, 0, -1));
    EXPECT_NEAR(typed.verticalFov, std::acos(0.5), 1e-12);
    // A camera that looks straight down is valid too.
    EXPECT_NO_THROW(makeCamera(selectCamera(scene, "0,9,0,0,0,0"), 1));
    for (const char* bad :
         {"2", "cellar", "1,2,3", "1,2,3,1,2,3", "0,0,0,0,0,nan", "0,0,0,1,0,0,180"})
        EXPECT_THROW(selectCamera(scene, bad), UsageError) << bad;
}
