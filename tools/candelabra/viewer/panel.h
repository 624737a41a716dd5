// SPDX-License-Identifier: Apache-2.0
// The panel of the viewer: figures of the last frames, and switches.
#pragma once

#include <deque>
#include <string>

#include "render/renderer.h"

namespace candelabra::app
{

// What the switches change.
struct PanelState {
    FrameOptions frame; // camera, time and deltaTime are the viewer's
    bool visible = true;
    bool animate = true;       // moving lights move
    uint32_t wantedLights = 0; // differs from the scene's: rebuild with as many
};

// What there is to see.
struct PanelFigures {
    std::string scene, device;
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

void drawPanel(PanelState& state, const PanelFigures& figures);

} // namespace candelabra::app
