// SPDX-License-Identifier: Apache-2.0
// Tests the generated scene of many rooms.
#include <gtest/gtest.h>

#include "generate/generators.h"
#include "generate/ray_caster.h"
#include "scene/scene_options.h"

namespace candelabra::app
{

TEST(Rooms, HaveTheSameTrianglesForEverySeed)
{
    for (const uint32_t seed : {1u, 2u}) {
        const Scene scene = generateRooms({.lights = 0, .seed = seed});
        size_t triangles = 0;
        for (const Instance& instance : scene.instances)
            triangles += scene.meshes[instance.mesh].indices.size() / 3;
        EXPECT_EQ(triangles, 22704u);
    }
}

// The purpose of the scene: walls hide most lights. Here from the points that the camera sees.
TEST(Rooms, WallsHideMostLights)
{
    const Scene scene = generateRooms({.lights = 960});
    RayCaster caster(scene);
    size_t pairs = 0, visible = 0;
    for (uint32_t pixel = 0; pixel < 100; ++pixel) {
        const auto hit = caster.cast(cameraRay(scene.cameras[0], pixel % 10, pixel / 10, 10, 10));
        ASSERT_TRUE(hit) << "the house is open at pixel " << pixel;
        for (size_t i = 0; i < scene.lights.size(); i += 7) {
            const CndLight& light = scene.lights[i];
            const glm::dvec3 way =
                scene.lightOrigin +
                glm::dvec3(light.position[0], light.position[1], light.position[2]) - hit->position;
            if (glm::dot(way, hit->normal) <= 0)
                continue;
            const double distance = glm::length(way);
            const auto wall = caster.cast({hit->position + 1e-6 * hit->normal, way / distance});
            ++pairs;
            visible += !wall || wall->distance > distance;
        }
    }
    EXPECT_GT(pairs, 3000u);
    EXPECT_LT(visible, pairs / 10);
    EXPECT_GT(visible, pairs / 200);
}

} // namespace candelabra::app
