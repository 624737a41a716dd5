// SPDX-License-Identifier: Apache-2.0
// The panel of the viewer: figures of the last frames, and switches.
#pragma once

#include <deque>
#include <optional>
#include <string>

#include "commands/pick.h"
#include "render/renderer.h"
#include "viewer/light_editor.h"
#include "json/save.h"

namespace candelabra::app
{

// The other way of shading beside which the chosen one is seen, left of the wipe.
struct Wipe {
    bool on = false;
    float at = 0.5f; // share of the window's width that is the chosen one's
    CndSpecularMethod specular = CND_SPECULAR_KARIS;
    CndCulling culling = CND_CULLING_CLUSTERED;
    float errorBudget = 0;
};

// What the switches change.
struct PanelState {
    FrameOptions frame; // camera, time and deltaTime are the viewer's
    bool visible = true;
    bool help = false;
    Wipe wipe;
    LightEditor editor;
    MaterialOverride materials;
    bool materialsChosen = false; // the override is to be applied
    bool animate = true;          // moving lights move
    uint32_t wantedLights = 0;    // differs from the scene's: rebuild with as many
};

// What there is to see.
struct PanelFigures {
    std::string scene, device;
    std::string note;           // what became of the last request, one sentence
    std::optional<Pick> picked; // the pixel asked for last
    uint32_t lights = 0;
    bool moving = false;
    double wallMs = 0; // between frames
    double speed = 0;  // of the camera, m/s
    PixelSize size;
    std::deque<std::vector<PassTime>> passes; // of the last frames, newest last
    CndLightingStats lighting{};
    CndExposureStats exposure{};
};

constexpr size_t panelFrames = 60; // frames the times are taken over

// `scene`: its lights are edited.
void drawPanel(PanelState& state, const PanelFigures& figures, Scene& scene);

} // namespace candelabra::app
