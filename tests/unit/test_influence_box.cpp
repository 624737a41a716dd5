// SPDX-License-Identifier: Apache-2.0
// Tests boxes around lights against views: no point that a camera shows may be lost.
#include <cmath>
#include <cstring>
#include <random>

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "lights/influence_box.h"

using namespace candelabra;
using namespace candelabra::lighting;

namespace
{

struct View {
    glm::dmat4 viewFromWorld;
    glm::dmat4 clipFromView;
    CndCamera camera{};
};

View makeView(const glm::dmat4& viewFromWorld, const glm::dmat4& clipFromView)
{
    View out{viewFromWorld, clipFromView};
    std::memcpy(out.camera.viewFromWorld, &viewFromWorld, sizeof out.camera.viewFromWorld);
    const glm::mat4 clip(clipFromView);
    std::memcpy(out.camera.clipFromView, &clip, sizeof out.camera.clipFromView);
    return out;
}

// Returns a random view, reversed and infinite or orthographic.
View randomView(std::mt19937& random)
{
    std::uniform_real_distribution<double> unit(-1, 1);
    const glm::dvec3 eye = 20.0 * glm::dvec3(unit(random), unit(random), unit(random));
    const glm::dvec3 to = eye + glm::dvec3(unit(random), unit(random), unit(random) + 1e-3);
    const glm::dmat4 view = glm::lookAt(eye, to, glm::dvec3(0.1, 1, 0.2));
    glm::dmat4 clip(0);
    const double width = std::exp2(3 * unit(random)), height = std::exp2(3 * unit(random));
    clip[0][0] = 1 / width;
    clip[1][1] = (random() % 2 ? -1 : 1) / height;
    if (random() % 3) {
        clip[2][0] = 0.3 * unit(random); // off centre
        clip[2][3] = -1;
        clip[3][2] = 0.1;
    } else {
        clip[3][1] = 0.3 * unit(random);
        clip[2][2] = 1e-3;
        clip[3][2] = 1;
        clip[3][3] = 1;
    }
    return makeView(view, clip);
}

InfluenceBox boxOf(const CndLight& light)
{
    return influenceBoxesOf({&light, 1})[light.type];
}

} // namespace

TEST(Reach, NoPointInViewIsLost)
{
    std::mt19937 random(1);
    std::uniform_real_distribution<double> unit(-1, 1);
    int shown = 0, leftOut = 0;
    for (int i = 0; i < 20000; ++i) {
        const View view = randomView(random);
        const CndLight light{.type = CND_LIGHT_SPHERE,
                             .position = {float(30 * unit(random)), float(30 * unit(random)),
                                          float(30 * unit(random))},
                             .influenceRadius = float(std::exp2(3 * unit(random)))};
        const double origin[3] = {unit(random), unit(random), unit(random)};
        const bool reaches = reachesView(boxOf(light), origin, view.camera);
        leftOut += !reaches;
        for (int k = 0; k < 20; ++k) {
            glm::dvec4 p(0, 0, 0, 1);
            for (int axis = 0; axis < 3; ++axis)
                p[axis] = origin[axis] + double(light.position[axis]) +
                          double(light.influenceRadius) * unit(random);
            const glm::dvec4 c = view.clipFromView * (view.viewFromWorld * p);
            if (c.w > 0 && std::abs(c.x) <= c.w && std::abs(c.y) <= c.w) {
                ++shown;
                ASSERT_TRUE(reaches) << i;
            }
        }
    }
    EXPECT_GT(shown, 10000);
    EXPECT_GT(leftOut, 5000); // lights are left out often enough to make the test worthwhile
}

TEST(Reach, ReplacedLightsWidenTheBox)
{
    CndLight lights[] = {{.type = CND_LIGHT_POINT, .position = {1, 2, 3}, .influenceRadius = 1},
                         {.type = CND_LIGHT_POINT, .position = {-5, 2, 9}, .influenceRadius = 2}};
    InfluenceBoxes boxes = influenceBoxesOf({lights, 1});
    widenBoxes(boxes, influenceBoxesOf({lights + 1, 1}));
    const InfluenceBox both = influenceBoxesOf(lights)[CND_LIGHT_POINT];
    EXPECT_EQ(boxes[CND_LIGHT_POINT].low, both.low);
    EXPECT_EQ(boxes[CND_LIGHT_POINT].high, both.high);
    EXPECT_EQ(both.low, glm::dvec3(-7, 0, 2));
    EXPECT_EQ(both.high, glm::dvec3(2, 4, 11));
}

TEST(Reach, LayersAreThoseOfAnyLight)
{
    CndLight lights[] = {{.type = CND_LIGHT_POINT, .influenceRadius = 1, .layers = 1},
                         {.type = CND_LIGHT_POINT, .influenceRadius = 1, .layers = 4},
                         {.type = CND_LIGHT_DIRECTIONAL}};
    InfluenceBoxes boxes = influenceBoxesOf({lights, 1});
    EXPECT_EQ(boxes[CND_LIGHT_POINT].layers, 1u);
    EXPECT_EQ(boxes[CND_LIGHT_DIRECTIONAL].layers, 0u);
    widenBoxes(boxes, influenceBoxesOf(lights));
    EXPECT_EQ(boxes[CND_LIGHT_POINT].layers, 5u);
    EXPECT_EQ(boxes[CND_LIGHT_DIRECTIONAL].layers, (1u << CND_LAYER_COUNT) - 1);
}

TEST(Reach, DistantAndEndlessLightsReachEverything)
{
    std::mt19937 random(2);
    const View view = randomView(random);
    const double origin[3] = {0, 0, 0};
    const CndLight sun{.type = CND_LIGHT_DIRECTIONAL};
    EXPECT_TRUE(reachesView(boxOf(sun), origin, view.camera));
    const CndLight endless{.type = CND_LIGHT_POINT, .influenceRadius = INFINITY};
    EXPECT_TRUE(reachesView(boxOf(endless), origin, view.camera));
    const InfluenceBoxes none = influenceBoxesOf({});
    EXPECT_FALSE(reachesView(none[CND_LIGHT_POINT], origin, view.camera));
}
