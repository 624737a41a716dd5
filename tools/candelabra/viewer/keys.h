// SPDX-License-Identifier: Apache-2.0
// The table of the viewer's keys and mouse actions, which its help window (F2) and the text of
// `candelabra view --help` show.
#pragma once

#include <string>

namespace candelabra::app
{

struct KeyHelp {
    const char* keys;
    const char* what;
};

constexpr KeyHelp keyHelp[] = {
    {"W A S D, Q E", "fly; Q goes down, E goes up; hold Shift to go fast"},
    {"drag, wheel", "look around; change the speed, or the distance in orbit"},
    {"O", "orbit the point ahead, or fly again"},
    {"F", "see the whole scene, in the direction of the view"},
    {"[ ]", "halve or double the number of lights"},
    {"- =", "lower or raise the exposure by 0.5 EV"},
    {"M", "next method of computing specular highlights"},
    {"C", "switch light culling: clustered or brute force"},
    {"H", "next heat map, or none (clustered culling only)"},
    {"B", "compare two ways of shading, left and right of a line"},
    {"N", "add a light above the middle of the view"},
    {"Tab", "select the next light; with Shift the previous one"},
    {"arrows, Page Up Down", "move the selected light"},
    {", .", "shrink or grow the selected light, keeping its power"},
    {"Delete", "remove the selected light"},
    {"K", "list the lights of the pixel under the mouse, with errors"},
    {"P, X", "save the image: P as shown (PNG), X as radiance (EXR)"},
    {"F5", "save the edited lights, camera and materials (.json)"},
    {"F1, F2", "show or hide the panel; this help"},
    {"Esc", "quit"},
    {"drop a file", "open a scene (.gltf .glb .json) or an environment (.hdr .exr .pfm)"},
};

// The table as text, one line per entry.
inline std::string keyHelpText()
{
    std::string out;
    for (const KeyHelp& help : keyHelp)
        out += std::string("  ") + help.keys + ": " + help.what + "\n";
    return out;
}

} // namespace candelabra::app
