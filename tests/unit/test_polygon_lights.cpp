// SPDX-License-Identifier: Apache-2.0
// Tests which polygons are accepted as lights, and how polygon lights are made from their corners.
#include <bit>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <glm/glm.hpp>
#include <gtest/gtest.h>

#include "gpu/failure.h"
#include "lights/pack_lights.h"
#include "lights/polygon.h"
#include "scene/polygons.h"

namespace candelabra::test
{
namespace
{

using app::regularPolygon;
using app::somePolygon;

glm::dvec3 vec(const float (&v)[3])
{
    return {v[0], v[1], v[2]};
}

glm::dvec3 packedCorner(const CndLight& light, uint32_t i)
{
    const float(&corner)[2] = light.polygon->corners[i];
    return vec(light.position) + double(corner[0]) * vec(light.axisU) +
           double(corner[1]) * vec(light.axisV);
}

CndLight lightOf(const CndPolygon* polygon)
{
    return {.type = CND_LIGHT_POLYGON,
            .emission = {1, 2, 3},
            .influenceRadius = INFINITY,
            .axisU = {2, 0, 0},
            .axisV = {0, 0.5f, 0},
            .polygon = polygon};
}

// Returns why the lighting module refuses a light; empty if it does not.
std::string refusal(const CndLight& light)
{
    try {
        lighting::validateLights("CndLightSet", {&light, 1});
        return "";
    } catch (const gpu::Failure& failure) {
        return failure.message;
    }
}

std::string refusal(const CndPolygon& polygon)
{
    return refusal(lightOf(&polygon));
}

// Corners of a polygon as its outline is evaluated, in the plane of the axes that were given.
std::vector<glm::dvec2> outlineCorners(const CndLight& light)
{
    const lighting::OutlinePolygon polygon = lighting::outlinePolygon(light);
    std::vector<glm::dvec2> out;
    for (uint32_t i = 0; i < polygon.count; ++i) {
        const glm::vec3 p =
            polygon.corners[i].x * polygon.axisU + polygon.corners[i].y * polygon.axisV;
        EXPECT_EQ(p.z, 0);
        out.push_back({p.x, p.y});
    }
    return out;
}

double areaOf(const std::vector<glm::dvec2>& corners)
{
    double twice = 0;
    for (size_t i = 0; i < corners.size(); ++i) {
        const glm::dvec2 &a = corners[i], &b = corners[(i + 1) % corners.size()];
        twice += a.x * b.y - a.y * b.x;
    }
    return twice / 2;
}

TEST(PolygonLights, WideOnesKeepTheirCorners)
{
    for (uint32_t i = 0; i < 12; ++i) {
        const CndLight light = lightOf(somePolygon(i));
        const lighting::OutlinePolygon outline = lighting::outlinePolygon(light);
        ASSERT_EQ(outline.count, light.polygon->cornerCount);
        EXPECT_EQ(outline.axisU, glm::vec3(2, 0, 0));
        for (uint32_t k = 0; k < outline.count; ++k)
            EXPECT_EQ(outline.corners[k],
                      glm::vec2(light.polygon->corners[k][0], light.polygon->corners[k][1]));
    }
}

// Both sides of a thin polygon have corners at the same places along it, and the area stays.
TEST(PolygonLights, ThinOnesAreDividedAlikeOnBothSides)
{
    std::vector<CndLight> lights;
    for (uint32_t i = 0; i < 12; ++i) {
        lights.push_back(lightOf(somePolygon(i)));
        lights.back().axisV[1] = i % 2 ? 1e-2f : 1e-5f;
    }
    // A sliver along the diagonal of its axes.
    const CndPolygon sliver{5,
                            {{-1, -1}, {0.2f, 0.1999f}, {1, 1}, {0, 0.0002f}, {-0.5f, -0.4999f}}};
    lights.push_back(lightOf(&sliver));
    lights.back().axisV[1] = 2;
    for (const CndLight& light : lights) {
        ASSERT_EQ(refusal(light), "");
        const std::vector<glm::dvec2> corners = outlineCorners(light);
        const double area = lighting::polygonArea(*light.polygon) * light.axisU[0] * light.axisV[1];
        EXPECT_NEAR(areaOf(corners) / area, 1, 1e-3);
        const glm::vec3 axis = lighting::outlinePolygon(light).axisU;
        const glm::dvec2 along = glm::normalize(glm::dvec2(axis.x, axis.y));
        const double length = glm::length(axis);
        for (size_t i = 0; i < corners.size(); ++i) {
            // Every corner has one on the other side, unless it is an end of the polygon.
            const double x = glm::dot(along, corners[i]);
            size_t near = 0;
            for (const glm::dvec2& other : corners)
                near += std::abs(glm::dot(along, other) - x) < 4e-4 * length;
            EXPECT_TRUE(near >= 2 || std::abs(x) > 0.5 * length) << i;
        }
    }
}

TEST(PolygonLights, GoodOnesAreAccepted)
{
    for (uint32_t i = 0; i < 12; ++i)
        EXPECT_EQ(refusal(*somePolygon(i)), "") << i;
    for (uint32_t corners = 3; corners <= CND_MAX_CORNERS; ++corners)
        EXPECT_EQ(refusal(*regularPolygon(corners)), "") << corners;
    // A corner in the middle of an edge.
    EXPECT_EQ(refusal(CndPolygon{4, {{-1, -1}, {0, -1}, {1, -1}, {0, 1}}}), "");
}

TEST(PolygonLights, BadOnesAreRefusedWithOneSentence)
{
    EXPECT_EQ(refusal(lightOf(nullptr)), "CndLightSet: lights[0]: polygon must not be NULL");
    for (const uint32_t count : {0u, 2u, 9u, UINT32_MAX}) {
        CndPolygon polygon = *regularPolygon(8);
        polygon.cornerCount = count;
        EXPECT_EQ(refusal(polygon), "CndLightSet: lights[0]: a polygon must have 3 to 8 corners");
    }
    for (const float bad : {1.001f, -2.0f, INFINITY, NAN}) {
        CndPolygon polygon = *regularPolygon(5);
        polygon.corners[3][1] = bad;
        EXPECT_EQ(
            refusal(polygon),
            "CndLightSet: lights[0]: the coordinates of a polygon's corners must be within -1..1");
        polygon = *regularPolygon(5);
        polygon.corners[5][0] = bad; // is not used
        EXPECT_EQ(refusal(polygon), "");
    }
    EXPECT_EQ(refusal(CndPolygon{4, {{-1, -1}, {1, -1}, {1, -1.0f + 5e-6f}, {0, 1}}}),
              "CndLightSet: lights[0]: two neighbouring corners of the polygon coincide");
    EXPECT_EQ(refusal(CndPolygon{3, {{-1, -1}, {0, 0}, {1, 1}}}),
              "CndLightSet: lights[0]: the corners of the polygon enclose no area");
    EXPECT_EQ(refusal(CndPolygon{3, {{-1, -1}, {0, 1}, {1, -1}}}),
              "CndLightSet: lights[0]: the corners of the polygon must go counterclockwise, from "
              "axisU to axisV");
    EXPECT_EQ(refusal(CndPolygon{4, {{-1, -1}, {1, -1}, {-0.5f, -0.5f}, {-1, 1}}}),
              "CndLightSet: lights[0]: the polygon must be convex");
    // The outline of a star turns to the left at every corner.
    CndPolygon star{.cornerCount = 5, .corners = {}};
    for (uint32_t i = 0; i < 5; ++i)
        for (int k = 0; k < 2; ++k)
            star.corners[i][k] = regularPolygon(5)->corners[2 * i % 5][k];
    EXPECT_EQ(refusal(star), "CndLightSet: lights[0]: the polygon must be convex");
    CndLight light = lightOf(regularPolygon(4));
    light.influenceRadius = 2; // the distance of a corner
    EXPECT_EQ(refusal(light),
              "CndLightSet: lights[0]: influenceRadius must be greater than the distance from the "
              "light's centre to the farthest point of its emitter");
    light.axisV[0] = 0.1f;
    EXPECT_EQ(refusal(light), "CndLightSet: lights[0]: axisU and axisV must be perpendicular");
    float power[3];
    CndError error{};
    light = lightOf(nullptr);
    EXPECT_EQ(cndLuminousPowerOfLight(&light, power, &error), CND_ERROR_INVALID_ARGUMENT);
    EXPECT_STREQ(error.message, "polygon must not be NULL");
}

TEST(PolygonLights, BoundingRadiusIsThatOfTheFarthestCorner)
{
    const CndPolygon polygon{3, {{-1, -0.5f}, {0.5f, -1}, {0.25f, 1}}};
    const CndLight light = lightOf(&polygon);
    EXPECT_FLOAT_EQ(cndEmitterBoundingRadius(&light), std::hypot(2.0f, 0.25f));
    EXPECT_EQ(cndLightFields(CND_LIGHT_POLYGON) & CND_LIGHT_FIELD_POLYGON_BIT,
              uint32_t{CND_LIGHT_FIELD_POLYGON_BIT});
    EXPECT_FALSE(cndIsPunctual(CND_LIGHT_POLYGON) || cndIsDistant(CND_LIGHT_POLYGON));
}

// Random polygons in random places, also far from the origin and very slender ones.
TEST(PolygonLights, FromCornersKeepsThem)
{
    std::mt19937 random(3);
    std::uniform_real_distribution<double> unit(-1, 1);
    const auto direction = [&] {
        return glm::normalize(glm::dvec3(unit(random), unit(random), 0.3));
    };
    for (uint32_t i = 0; i < 2000; ++i) {
        const CndPolygon& outline = *somePolygon(i);
        const double extent = std::pow(10, 3 * unit(random));
        const glm::dvec3 u = direction(), v = glm::normalize(glm::cross(u, direction()));
        const glm::dvec3 centre = extent * 3 * direction();
        float corners[CND_MAX_CORNERS][3];
        for (uint32_t k = 0; k < outline.cornerCount; ++k) {
            const float(&at)[2] = outline.corners[k];
            const glm::dvec3 corner = centre + extent * double(at[0]) * u +
                                      extent * std::pow(10, -1.5 * (i % 3)) * double(at[1]) * v;
            for (int c = 0; c < 3; ++c)
                corners[k][c] = float(corner[c]);
        }
        CndLight light{.emission = {1, 1, 1}, .influenceRadius = INFINITY, .twoSided = VK_TRUE};
        CndPolygon polygon;
        CndError error{};
        ASSERT_EQ(cndPolygonFromCorners(corners, outline.cornerCount, &light, &polygon, &error),
                  CND_SUCCESS)
            << i << ": " << error.message;
        ASSERT_EQ(refusal(light), "") << i;
        EXPECT_EQ(light.polygon, &polygon);
        EXPECT_EQ(light.twoSided, VK_TRUE); // other fields stay
        for (uint32_t k = 0; k < outline.cornerCount; ++k)
            EXPECT_LT(glm::distance(packedCorner(light, k), vec(corners[k])), 2e-6 * extent) << i;
        const glm::dvec3 normal = glm::normalize(glm::cross(vec(light.axisU), vec(light.axisV)));
        EXPECT_GT(glm::dot(normal, glm::cross(u, v)), 1 - 1e-5) << i;
    }
}

TEST(PolygonLights, FromCornersInReverseFacesTheOtherWay)
{
    const float corners[3][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    const float reversed[3][3] = {{0, 1, 0}, {1, 0, 0}, {0, 0, 0}};
    CndLight up{}, down{};
    CndPolygon polygons[2];
    ASSERT_EQ(cndPolygonFromCorners(corners, 3, &up, &polygons[0], nullptr), CND_SUCCESS);
    ASSERT_EQ(cndPolygonFromCorners(reversed, 3, &down, &polygons[1], nullptr), CND_SUCCESS);
    EXPECT_GT(glm::cross(vec(up.axisU), vec(up.axisV)).z, 0);
    EXPECT_LT(glm::cross(vec(down.axisU), vec(down.axisV)).z, 0);
}

TEST(PolygonLights, FromBadCornersSaysWhyAndWritesNothing)
{
    const auto refused = [](std::vector<glm::vec3> corners, uint32_t count) {
        CndLight light{};
        CndPolygon polygon{};
        CndError error{};
        EXPECT_EQ(cndPolygonFromCorners(reinterpret_cast<const float(*)[3]>(corners.data()), count,
                                        &light, &polygon, &error),
                  CND_ERROR_INVALID_ARGUMENT);
        EXPECT_TRUE(light.type == 0 && !light.polygon && polygon.cornerCount == 0);
        return std::string(error.message);
    };
    const std::vector<glm::vec3> square = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    EXPECT_EQ(refused(square, 2), "a polygon must have 3 to 8 corners");
    EXPECT_EQ(refused(square, 9), "a polygon must have 3 to 8 corners");
    std::vector<glm::vec3> bad = square;
    bad[2].z = 0.01f;
    EXPECT_EQ(refused(bad, 4), "the corners are not in a plane");
    bad[2] = {NAN, 1, 0};
    EXPECT_EQ(refused(bad, 4), "corners[2] is not finite or beyond 1e15 m");
    EXPECT_EQ(refused({{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}, 3), "all corners coincide");
    EXPECT_EQ(refused({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, 3), "the corners enclose no area");
    EXPECT_EQ(refused({{0, 0, 0}, {1, 0, 0}, {1, 0, 0}, {0, 1, 0}}, 4),
              "two neighbouring corners of the polygon coincide");
    EXPECT_EQ(refused({{0, 0, 0}, {1, 0, 0}, {0.2f, 0.2f, 0}, {0, 1, 0}}, 4),
              "the polygon must be convex");
    EXPECT_EQ(refused({{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}}, 4),
              "the corners enclose no area"); // two triangles of opposite windings
}

} // namespace
} // namespace candelabra::test
