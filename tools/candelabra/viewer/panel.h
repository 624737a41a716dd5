// SPDX-License-Identifier: Apache-2.0
// The viewer's panel: shows measurements of the last frames and changes how frames are drawn.
#pragma once

#include <deque>
#include <optional>
#include <string>

#include "measure/frame/pick.h"
#include "render/renderer.h"
#include "viewer/light_editor.h"
#include "viewer/moving_size.h"
#include "json/save.h"

namespace candelabra::app
{

// The A/B comparison ("wipe"): left of a line the image is shaded as PanelState::frame says. From
// the line on, the settings here replace those of PanelState::frame.
struct Wipe {
    bool on = false;
    float at = 0.5f; // place of the line, as a fraction of the window's width
    CndSpecularMethod specular = CND_SPECULAR_KARIS;
    CndCulling culling = CND_CULLING_CLUSTERED;
};

// An object that the user has clicked, other than a light.
struct SelectedObject {
    std::string name;
    Bounds bounds;         // world space
    uint32_t material = 0; // of the surface that was clicked
};

// The settings that the user changes, with the panel or with keys.
struct PanelState {
    FrameOptions frame; // the viewer fills in camera, time and deltaTime
    bool visible = true;
    bool help = false;      // the window with keys and mouse is open
    bool collapsed = false; // the panel was last collapsed because the window is small
    std::string shownNote;  // the last PanelFigures::note, and when it came
    double noteTime = 0;
    double noteLeft = 0; // seconds for which the note will still be shown
    Wipe wipe;
    LightEditor editor;
    std::optional<SelectedObject> object; // nothing if a light is selected
    MaterialOverride materials;
    bool materialsChosen = false; // `materials` was changed and must be applied to the scene
    bool animate = true;          // moving lights move
    WhileMoving whileMoving = WhileMoving::Auto;
    std::optional<size_t> wantedCamera; // of the scene; the viewer goes there
    uint32_t wantedLights = 0;          // the scene is rebuilt if it has another number of lights
};

// The figures that the panel shows.
struct PanelFigures {
    std::string scene, device;
    std::string note;           // result of the user's last request, one sentence
    std::optional<Pick> picked; // the pixel that was picked last
    uint32_t lights = 0;
    bool moving = false;                      // the scene has moving lights
    double wallMs = 0;                        // time between the starts of the last two frames
    double speed = 0;                         // of the camera, m/s
    PixelSize size, drawnSize;                // of the window; of the picture, which may be smaller
    uint64_t frames = 0;                      // how many have drawn the picture
    uint32_t summed = 0;                      // samples in the sum of a still picture
    bool complete = false;                    // no more frames are drawn until something changes
    std::deque<std::vector<PassTime>> passes; // one entry per frame, the newest last
    CndLightingStats lighting{};
    CndExposureStats exposure{};
};

constexpr size_t panelFrames = 60; // number of frames over which pass times are summarised

// Draws the panel, the help window and the line of the wipe. The light editor changes the lights of
// `scene`.
void drawPanel(PanelState& state, const PanelFigures& figures, Scene& scene);

} // namespace candelabra::app
