// SPDX-License-Identifier: Apache-2.0
// Tests what the viewer's editor does to lights: they stay valid and keep their power.
#include <cstring>

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
        EXPECT_NO_THROW(lighting::validateLights("edited", scene.lights)) << light.radius;
    }
}

TEST(LightEditor, EveryTypeBecomesEveryOtherAndIsValid)
{
    for (uint32_t from = 0; from < CND_LIGHT_TYPE_COUNT; ++from)
        for (uint32_t to = 0; to < CND_LIGHT_TYPE_COUNT; ++to) {
            LightEditor editor;
            Scene scene = sceneWithALight(editor);
            changeType(scene.lights[0], CndLightType(from));
            EXPECT_NO_THROW(lighting::validateLights("edited", scene.lights)) << from;
            changeType(scene.lights[0], CndLightType(to));
            EXPECT_NO_THROW(lighting::validateLights("edited", scene.lights)) << from << " " << to;
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
        EXPECT_NO_THROW(lighting::validateLights("edited", scene.lights)) << corners;
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

bool sameLight(const CndLight& a, const CndLight& b)
{
    return std::memcmp(&a, &b, sizeof a) == 0;
}

TEST(LightHistory, UndoesAndRedoesEveryKindOfEdit)
{
    LightEditor editor;
    Scene scene;
    scene.lightMotions = {};
    std::vector<std::vector<CndLight>> states{scene.lights};
    const auto step = [&](auto&& edit) {
        editor.history.beginStep();
        edit();
        states.push_back(scene.lights);
    };
    step([&] { addLight(scene, editor, {1, 2, 3}); });
    step([&] { addLight(scene, editor, {4, 5, 6}); });
    step([&] { moveLight(scene, editor, {1, 0, 0}); });
    step([&] { scaleLightRadius(scene, editor, 2); });
    step([&] { duplicateLight(scene, editor); });
    step([&] { selectLight(scene, editor, 1), removeLight(scene, editor); });
    ASSERT_EQ(scene.lights.size(), 2u);
    const auto expect = [&](const std::vector<CndLight>& wanted) {
        ASSERT_EQ(scene.lights.size(), wanted.size());
        for (size_t i = 0; i < wanted.size(); ++i)
            EXPECT_TRUE(sameLight(scene.lights[i], wanted[i])) << i;
    };
    for (size_t i = states.size() - 1; i > 0; --i) {
        EXPECT_EQ(undoEdit(scene, editor).substr(0, 8), "undone: ");
        expect(states[i - 1]);
    }
    EXPECT_EQ(undoEdit(scene, editor), "there is no edit to undo");
    for (size_t i = 1; i < states.size(); ++i) {
        EXPECT_EQ(redoEdit(scene, editor).substr(0, 8), "redone: ");
        expect(states[i]);
    }
    EXPECT_EQ(redoEdit(scene, editor), "there is no edit to redo");
    // An edit after an undo takes the place of what was undone.
    undoEdit(scene, editor);
    step([&] { addLight(scene, editor, {7, 8, 9}); });
    EXPECT_FALSE(editor.history.canRedo());
}

TEST(LightHistory, KeepsTheMotionOfRemovedLights)
{
    LightEditor editor;
    Scene scene = sceneWithALight(editor);
    scene.lightMotions = {{.angularSpeed = 3}};
    removeLight(scene, editor);
    EXPECT_TRUE(scene.lightMotions.empty());
    undoEdit(scene, editor);
    ASSERT_EQ(scene.lightMotions.size(), 1u);
    EXPECT_EQ(scene.lightMotions[0].angularSpeed, 3);
    removeLight(scene, editor);
    addLight(scene, editor, {0, 0, 0}); // a scene without moving lights
    EXPECT_TRUE(scene.lightMotions.empty());
    scene.lightMotions = {{.angularSpeed = 5}};
    removeLight(scene, editor);
    addLight(scene, editor, {0, 0, 0});
    scene.lightMotions = {{.angularSpeed = 7}};
    duplicateLight(scene, editor);
    ASSERT_EQ(scene.lightMotions.size(), 2u);
    EXPECT_EQ(scene.lightMotions[1].angularSpeed, 7);
    removeLight(scene, editor);
    undoEdit(scene, editor);
    ASSERT_EQ(scene.lightMotions.size(), 2u);
    EXPECT_EQ(scene.lightMotions[1].angularSpeed, 7);
}

TEST(LightHistory, ADragIsOneStep)
{
    LightEditor editor;
    Scene scene = sceneWithALight(editor);
    const CndLight before = scene.lights[0];
    editor.history.beginStep();
    for (int i = 0; i < 20; ++i)
        moveLight(scene, editor, {0.1f, 0, 0});
    undoEdit(scene, editor);
    EXPECT_TRUE(sameLight(scene.lights[0], before));
    editor.history.beginStep();
    moveLight(scene, editor, {0.5f, 0, 0});
    moveLight(scene, editor, {-0.5f, 0, 0}); // back where it was: no step
    EXPECT_EQ(undoEdit(scene, editor), "undone: light 0 added");
}

TEST(LightHistory, HasALimit)
{
    LightEditor editor;
    Scene scene = sceneWithALight(editor);
    for (size_t i = 0; i < LightHistory::mostSteps + 10; ++i) {
        editor.history.beginStep();
        moveLight(scene, editor, {1, 0, 0});
    }
    size_t steps = 0;
    while (editor.history.canUndo()) {
        undoEdit(scene, editor);
        ++steps;
    }
    EXPECT_EQ(steps, LightHistory::mostSteps);
    EXPECT_EQ(scene.lights[0].position[0], 11); // 1 at first; ten moves cannot be undone
}

TEST(LightHistory, KnowsWhetherTheLightsAreWhatTheyWere)
{
    LightEditor editor;
    Scene scene;
    const auto state = [&] { return editor.history.state(); };
    const uint64_t loaded = state();
    addLight(scene, editor, {1, 2, 3});
    const uint64_t saved = state();
    EXPECT_NE(saved, loaded);
    undoEdit(scene, editor);
    EXPECT_EQ(state(), loaded);
    redoEdit(scene, editor);
    EXPECT_EQ(state(), saved);
    editor.history.beginStep();
    for (int i = 0; i < 2; ++i) { // one step
        moveLight(scene, editor, {1, 0, 0});
        EXPECT_NE(state(), saved);
    }
    undoEdit(scene, editor);
    EXPECT_EQ(state(), saved);
    undoEdit(scene, editor);
    addLight(scene, editor, {1, 2, 3}); // another light in the place of the first
    EXPECT_NE(state(), saved);
    for (size_t i = 0; i < LightHistory::mostSteps; ++i) {
        editor.history.beginStep();
        moveLight(scene, editor, {1, 0, 0});
    }
    while (editor.history.canUndo())
        undoEdit(scene, editor);
    EXPECT_NE(state(), loaded); // the first step was forgotten
}

} // namespace
