// SPDX-License-Identifier: Apache-2.0
// Adds, changes and removes lights of a scene. Every edit leaves the lights valid for the lighting
// module. Only drawLightEditor needs a window.
#pragma once

#include <optional>
#include <string>

#include "scene/scene.h"
#include "viewer/light_history.h"

namespace candelabra::app
{

struct LightEditor {
    std::optional<uint32_t> selected; // index of a light of the scene
    bool changed = false; // set by every edit; the viewer resets it when it has told its renderers
    LightHistory history;
    bool wantsNew = false; // the user asks for a new light, which the viewer adds
    bool watts = false;    // the power is shown in W at 555 nm, not in lm
    // The lights cannot be edited while the scene is rebuilt with another number of them.
    bool locked = false;
};

// The text that the user sees while the editor is locked.
constexpr const char* editorLocked =
    "the scene is built anew with other lights, which can be edited when they are there";

// The size and the strength of a new sphere light. The default is enough for a room.
struct NewLight {
    float radius = 0.1f;        // metres
    float power = 1500;         // lm
    float influenceRadius = 12; // metres
};

// Adds a sphere light at `position` (metres, world space) and selects it.
void addLight(Scene& scene, LightEditor& editor, const glm::dvec3& position,
              const NewLight& light = {});
// Adds a copy of the selected light beside it and selects the copy.
void duplicateLight(Scene& scene, LightEditor& editor);
void removeLight(Scene& scene, LightEditor& editor);
// Moves the selection by `step` lights; after the last light comes the first.
void selectLight(const Scene& scene, LightEditor& editor, int step);
bool moveLight(Scene& scene, LightEditor& editor, const glm::vec3& metres);
// Multiplies the radius of the selected light by `factor`, if that light has a radius.
bool scaleLightRadius(Scene& scene, LightEditor& editor, float factor);

// Undo or redo the last step, if there is one, and select the light that it was about. They return
// what was done in a few words, such as "undone: light 3 moved", or that there is nothing to do.
std::string undoEdit(Scene& scene, LightEditor& editor);
std::string redoEdit(Scene& scene, LightEditor& editor);

// Change one light's type or its radius. The luminous power stays the same where the light has one
// before and after; a distant sphere keeps its illuminance when its radius changes.
void changeType(CndLight& light, CndLightType type);
void changeRadius(CndLight& light, float radius);
// Makes a polygon regular, with 3 to CND_MAX_CORNERS corners. The luminous power stays the same.
void changeCorners(CndLight& light, uint32_t corners);

// Draws the widgets that edit the selected light, and applies what the user does with them.
void drawLightEditor(Scene& scene, LightEditor& editor);

} // namespace candelabra::app
