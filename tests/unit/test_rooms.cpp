// SPDX-License-Identifier: Apache-2.0
// Tests the generated scene of many rooms.
#include <cstring>

#include <gtest/gtest.h>

#include "generate/generators.h"
#include "generate/ray_caster.h"
#include "scene/scene_options.h"
#include "unit/scene_invariants.h"

namespace candelabra::app
{

TEST(Rooms, HoldWhatTheLoadersPromise)
{
    const Scene scene = generateRooms({.lights = 500});
    EXPECT_EQ(test::brokenInvariant(scene), "");
    EXPECT_EQ(scene.lights.size(), 500u);
    size_t triangles = 0;
    for (const Instance& instance : scene.instances) {
        triangles += scene.meshes[instance.mesh].indices.size() / 3;
        ASSERT_GT(glm::determinant(glm::dmat3(instance.worldFromObject)), 0);
    }
    EXPECT_EQ(triangles, 22704u);
}

TEST(Rooms, DependOnTheSeedAlone)
{
    SceneOptions options{.lights = 100, .moving = true};
    const Scene a = generateRooms(options), b = generateRooms(options);
    options.seed = 2;
    const Scene c = generateRooms(options);
    const auto same = [](const Scene& x, const Scene& y) {
        return std::memcmp(x.lights.data(), y.lights.data(), 100 * sizeof(CndLight)) == 0 &&
               x.instances[60].worldFromObject == y.instances[60].worldFromObject;
    };
    EXPECT_EQ(a.lightMotions.size(), 100u);
    EXPECT_TRUE(same(a, b));
    EXPECT_FALSE(same(a, c));
    EXPECT_EQ(c.instances.size(), a.instances.size());
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
