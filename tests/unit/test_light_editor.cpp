// SPDX-License-Identifier: Apache-2.0
// Tests what the viewer's editor does to lights: they stay valid and keep their power.
#include <cmath>

#include <gtest/gtest.h>

#include "lights/pack_lights.h"
#include "scene/light_types.h"
#include "viewer/light_editor.h"

using namespace candelabra;
using namespace candelabra::app;

namespace
{

float powerOf(const CndLight& light)
{
    float power[3]{};
    EXPECT_EQ(cndLuminousPowerOfLight(&light, power, nullptr), CND_SUCCESS);
    return power[1];
}

Scene sceneWithALight(LightEditor& editor)
{
    Scene scene;
    scene.lightOrigin = {100, 0, 0};
    addLight(scene, editor, {101, 2, 3});
    return scene;
}

TEST(LightEditor, AddsSelectsMovesAndRemoves)
{
    LightEditor editor;
    Scene scene = sceneWithALight(editor);
    EXPECT_TRUE(editor.changed);
    EXPECT_EQ(editor.selected, 0u);
    EXPECT_EQ(scene.lights[0].position[0], 1); // relative to the origin of the set
    scene.lightMotions.resize(1);
    addLight(scene, editor, {0, 0, 0});
    EXPECT_EQ(scene.lightMotions.size(), 2u); // one per light, or none
    selectLight(scene, editor, 1);
    EXPECT_EQ(editor.selected, 0u);
    selectLight(scene, editor, -1);
    EXPECT_EQ(editor.selected, 1u);
    editor.changed = false;
    moveLight(scene, editor, {0, 0.5f, 0});
    EXPECT_TRUE(editor.changed);
    EXPECT_EQ(scene.lights[1].position[1], 0.5f);
    removeLight(scene, editor);
    EXPECT_EQ(scene.lights.size(), 1u);
    EXPECT_EQ(scene.lightMotions.size(), 1u);
    EXPECT_FALSE(editor.selected);
    editor.changed = false;
    removeLight(scene, editor); // no light is selected
    moveLight(scene, editor, {1, 1, 1});
    scaleLightRadius(scene, editor, 2);
    EXPECT_FALSE(editor.changed);
    EXPECT_EQ(scene.lights.size(), 1u);
}

TEST(LightEditor, NothingToSelectWithoutLights)
{
    Scene scene;
    LightEditor editor;
    selectLight(scene, editor, 1);
    EXPECT_FALSE(editor.selected);
}

TEST(LightEditor, RadiusKeepsPowerAndStaysWithinInfluence)
{
    LightEditor editor;
    Scene scene = sceneWithALight(editor);
    CndLight& light = scene.lights[0];
    const float power = powerOf(light);
    EXPECT_NEAR(power, 1500, 0.01);
    for (const float factor : {3.0f, 1e9f, 1e-12f, 40.0f}) {
        scaleLightRadius(scene, editor, factor);
        EXPECT_NEAR(powerOf(light), power, 1e-4 * power) << light.radius;
        EXPECT_NO_THROW(lighting::validateLights(scene.lights)) << light.radius;
    }
}

TEST(LightEditor, EveryTypeBecomesEveryOtherAndIsValid)
{
    for (uint32_t from = 0; from < CND_LIGHT_TYPE_COUNT; ++from)
        for (uint32_t to = 0; to < CND_LIGHT_TYPE_COUNT; ++to) {
            LightEditor editor;
            Scene scene = sceneWithALight(editor);
            changeType(scene.lights[0], CndLightType(from));
            EXPECT_NO_THROW(lighting::validateLights(scene.lights)) << from;
            changeType(scene.lights[0], CndLightType(to));
            EXPECT_NO_THROW(lighting::validateLights(scene.lights)) << from << " " << to;
            EXPECT_GT(scene.lights[0].emission[1], 0) << from << " " << to;
        }
    // A conversion between types that have a luminous power keeps it.
    LightEditor editor;
    Scene scene = sceneWithALight(editor);
    for (const CndLightType type : {CND_LIGHT_TUBE, CND_LIGHT_RECTANGLE, CND_LIGHT_DISC,
                                    CND_LIGHT_POLYGON, CND_LIGHT_SPOT, CND_LIGHT_POINT}) {
        changeType(scene.lights[0], type);
        EXPECT_NEAR(powerOf(scene.lights[0]), 1500, 0.1) << lightTypeName(type);
    }
}

TEST(LightEditor, CornersKeepPower)
{
    LightEditor editor;
    Scene scene = sceneWithALight(editor);
    changeType(scene.lights[0], CND_LIGHT_POLYGON);
    for (uint32_t corners = 3; corners <= CND_MAX_CORNERS; ++corners) {
        changeCorners(scene.lights[0], corners);
        EXPECT_NO_THROW(lighting::validateLights(scene.lights)) << corners;
        EXPECT_EQ(scene.lights[0].polygon->cornerCount, corners);
        EXPECT_NEAR(powerOf(scene.lights[0]), 1500, 0.1) << corners;
    }
}

TEST(LightEditor, DistantSphereKeepsItsIlluminance)
{
    LightEditor editor;
    Scene scene = sceneWithALight(editor);
    CndLight& light = scene.lights[0];
    changeType(light, CND_LIGHT_DISTANT_SPHERE);
    const float before = light.emission[0] * light.radius * light.radius;
    changeRadius(light, 0.1f);
    EXPECT_NEAR(light.emission[0] * light.radius * light.radius, before, 1e-5f * before);
}

} // namespace
