// SPDX-License-Identifier: Apache-2.0
// Tests which light is under the mouse of the viewer, and where its outline is drawn.
#include <gtest/gtest.h>

#include "scene/light_types.h"
#include "scene/polygons.h"
#include "viewer/light_handles.h"

using namespace candelabra;
using namespace candelabra::app;

namespace
{

constexpr double unhidden = std::numeric_limits<double>::infinity();
constexpr PixelSize clickSize{400, 200};

// At the origin, looking along -z; at a depth of 10 m a pixel is 0.1 m wide.
Projection clickView(bool orthographic = false)
{
    Camera camera;
    camera.verticalFov = 2 * std::atan(1.0);
    camera.orthographic = orthographic;
    camera.orthographicHeight = 20;
    return {camera, clickSize};
}

CndLight clickableLight(CndLightType type, float x, float y, float z)
{
    CndLight light = lightTypeInfo(type).lamp;
    light.type = type;
    light.position[0] = x;
    light.position[1] = y;
    light.position[2] = z;
    light.direction[2] = 1;
    light.radius = 1;
    light.axisU[0] = 2;
    light.axisU[1] = light.axisU[2] = 0;
    light.axisV[1] = 1;
    light.axisV[0] = light.axisV[2] = 0;
    light.polygon = regularPolygon(6);
    light.influenceRadius = 20;
    return light;
}

std::optional<uint32_t> clickedAt(const std::vector<CndLight>& lights, glm::dvec2 place,
                                  double farthest = unhidden, bool orthographic = false)
{
    return lightAt(lights, glm::dvec3(0), clickView(orthographic), place, 6, farthest);
}

TEST(LightShape, EveryTypeIsFoundAtItsOutlineAndNotBeyond)
{
    for (const bool orthographic : {false, true})
        for (uint32_t type = 0; type < CND_LIGHT_TYPE_COUNT; ++type) {
            if (cndIsDistant(type))
                continue;
            const std::vector<CndLight> lights{clickableLight(CndLightType(type), 0, 0, -10)};
            const auto outline = outlineOf(lights[0], glm::dvec3(0), clickView(orthographic));
            ASSERT_FALSE(outline.empty()) << lightTypeName(type);
            double right = 0;
            for (const auto& line : outline)
                for (const glm::dvec2& end : clickView(orthographic).segments(line))
                    right = std::max(right, end.x);
            // A point is drawn as a ring, which is wider than the slack, and a spot with its cone.
            if (cndIsPunctual(type))
                right = 200;
            EXPECT_EQ(clickedAt(lights, {200, 100}, unhidden, orthographic), 0u)
                << lightTypeName(type);
            EXPECT_EQ(clickedAt(lights, {right + 4, 100}, unhidden, orthographic), 0u)
                << lightTypeName(type) << right;
            EXPECT_FALSE(clickedAt(lights, {right + 9, 100}, unhidden, orthographic))
                << lightTypeName(type) << right;
        }
}

TEST(LightShape, OutlinesHaveTheSizeOfTheEmitter)
{
    const auto rightOf = [](CndLightType type) {
        double right = 0;
        const CndLight light = clickableLight(type, 0, 0, -10);
        for (const auto& line : outlineOf(light, glm::dvec3(0), clickView()))
            for (const glm::dvec2& end : clickView().segments(line))
                right = std::max(right, end.x);
        return right;
    };
    EXPECT_NEAR(rightOf(CND_LIGHT_SPHERE), 210, 1e-6);
    EXPECT_NEAR(rightOf(CND_LIGHT_DISC), 210, 1e-6);
    EXPECT_NEAR(rightOf(CND_LIGHT_RECTANGLE), 220, 1e-6);
    EXPECT_NEAR(rightOf(CND_LIGHT_POLYGON), 220, 1e-6);
    EXPECT_TRUE(
        outlineOf(clickableLight(CND_LIGHT_DIRECTIONAL, 0, 0, 0), glm::dvec3(0), clickView())
            .empty());
}

TEST(LightShape, TheNearestLightWinsThenTheFirst)
{
    std::vector<CndLight> lights{
        clickableLight(CND_LIGHT_SPHERE, 0, 0, -20), clickableLight(CND_LIGHT_SPHERE, 0, 0, -10),
        clickableLight(CND_LIGHT_SPHERE, 0, 0, -10), clickableLight(CND_LIGHT_SPHERE, 0, 0, 10),
        clickableLight(CND_LIGHT_SPHERE, 1.5f, 0, -5)};
    EXPECT_EQ(clickedAt(lights, {200, 100}), 1u); // under the mouse, and nearer than the first
    EXPECT_EQ(clickedAt(lights, {208, 100}), 1u);
    lights.erase(lights.begin() + 1, lights.begin() + 3);
    EXPECT_EQ(clickedAt(lights, {200, 100}), 0u);
    // This light is behind the camera.
    EXPECT_FALSE(clickedAt({lights[1]}, {200, 100}));
}

TEST(LightShape, SurfacesHideLights)
{
    const std::vector<CndLight> lights{clickableLight(CND_LIGHT_SPHERE, 0, 0, -10)};
    EXPECT_FALSE(clickedAt(lights, {200, 100}, 8.5));
    EXPECT_EQ(clickedAt(lights, {200, 100}, 9.5), 0u); // a part of the emitter is in front
}

TEST(LightShape, IsFoundAmong100000)
{
    std::vector<CndLight> lights;
    for (int i = 0; i < 100'000; ++i) {
        CndLight light =
            clickableLight(CND_LIGHT_SPHERE, float(i % 317) - 158, float(i / 317) - 158, -300);
        light.radius = 0.2f;
        lights.push_back(light);
    }
    const glm::dvec2 place{200 + 7 / 3.0, 100 - 9 / 3.0}; // a pixel is 3 m wide there
    EXPECT_EQ(lightAt(lights, glm::dvec3(0), clickView(), place, 0.1, unhidden),
              uint32_t((158 + 9) * 317 + 158 + 7));
}

// A handle is found at its place in the picture. The point that is dragged by it stays under the
// mouse, and leaves neither the line nor the plane of the handle.
TEST(LightHandles, AreFoundAndFollowTheMouse)
{
    Camera camera;
    camera.forward = glm::normalize(glm::dvec3(-1, -1, -2));
    camera.position = glm::dvec3(1, 2, 3) - 10.0 * camera.forward;
    const Projection view(camera, clickSize);
    const LightHandles handles{{1, 2, 3}, 2};
    const auto middleOf = [&](uint32_t handle) {
        glm::dvec3 sum(0);
        const auto outline = handles.outlineOf(handle);
        const size_t corners = outline.size() == 2 ? 2 : 4;
        for (size_t i = 0; i < corners; ++i)
            sum += outline[i] / double(corners);
        return sum;
    };
    const auto placeOf = [&](const glm::dvec3& p) { return view.segments({p, p}).at(0); };
    for (const uint32_t handle : LightHandles::all) {
        const glm::dvec3 from = middleOf(handle);
        EXPECT_EQ(handles.at(view, placeOf(from), 4), handle);
        glm::dvec3 to = from;
        for (int axis = 0; axis < 3; ++axis)
            if (handle >> axis & 1)
                to[axis] += 0.5 + 0.25 * axis;
        const auto point = handles.pointOn(handle, view, placeOf(to));
        ASSERT_TRUE(point) << handle;
        // Rounding separates the point from where the mouse was moved.
        EXPECT_LT(glm::length(*point - to), 1e-9) << handle;
    }
    EXPECT_FALSE(handles.at(view, placeOf({1, 2, 3}) + glm::dvec2(80, 0), 4));
    // The mouse cannot drag along a line that points to the camera, or in a plane that is seen from
    // its edge.
    camera.forward = {0, 0, -1};
    camera.position = {1, 2, 13};
    const Projection straight(camera, clickSize);
    EXPECT_FALSE(handles.pointOn(4, straight, {200, 100}));
    EXPECT_FALSE(handles.pointOn(5, straight, {200, 100}));
    EXPECT_TRUE(handles.pointOn(3, straight, {200, 100}));
}

} // namespace
