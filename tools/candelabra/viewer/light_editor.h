// SPDX-License-Identifier: Apache-2.0
// Adds, changes and removes lights of a scene, always leaving them valid. No window here but for
// drawLightEditor.
#pragma once

#include <optional>

#include "scene/scene.h"

namespace candelabra::app
{

struct LightEditor {
    std::optional<uint32_t> selected;
    bool changed = false; // since whoever draws the scene was told
};

// At a place in the world; selects it. A sphere that lights a room.
void addLight(Scene& scene, LightEditor& editor, const glm::dvec3& position);
void removeLight(Scene& scene, LightEditor& editor);
// `step` lights on, around the end.
void selectLight(const Scene& scene, LightEditor& editor, int step);
void moveLight(Scene& scene, LightEditor& editor, const glm::vec3& metres);
// Of the selected light, if it has a radius.
void scaleLightRadius(Scene& scene, LightEditor& editor, float factor);

// One light. Power is kept where both types, or both sizes, have one.
void changeType(CndLight& light, CndLightType type);
void changeRadius(CndLight& light, float radius);

const char* lightTypeName(CndLightType type);

// Widgets for the selected light.
void drawLightEditor(Scene& scene, LightEditor& editor);

} // namespace candelabra::app
