// SPDX-License-Identifier: Apache-2.0
// What keys and mouse do in the viewer, for everything that lists them.
#pragma once

#include <string>

namespace candelabra::app
{

struct KeyHelp {
    const char* keys;
    const char* what;
};

constexpr KeyHelp keyHelp[] = {
    {"W A S D, Q E", "fly; down and up; Shift: fast"},
    {"drag, wheel", "look; speed, or distance in orbit"},
    {"O", "orbit, or fly again"},
    {"[ ]", "half and double the lights"},
    {"- =", "exposure compensation"},
    {"M", "next specular method"},
    {"C", "culling: clustered, brute force"},
    {"H", "heat maps"},
    {"B", "A/B: wipe between two ways of shading"},
    {"N", "new light in front of the camera"},
    {"Tab", "select the next light; Shift: the one before"},
    {"arrows, Page Up Down", "move the selected light"},
    {", .", "its radius, at the same power"},
    {"Delete", "remove it"},
    {"K", "the lights of the pixel under the mouse, and their errors"},
    {"P, X", "save the image: PNG as shown, EXR of luminance"},
    {"F5", "save the scene (.json): lights, camera, materials as edited"},
    {"F1, F2", "panel, this help"},
    {"Esc", "quit"},
    {"drop a file", "scene (.gltf .glb .json) or environment (.hdr .exr .pfm)"},
};

// One line each.
inline std::string keyHelpText()
{
    std::string out;
    for (const KeyHelp& help : keyHelp)
        out += std::string("  ") + help.keys + ": " + help.what + "\n";
    return out;
}

} // namespace candelabra::app
