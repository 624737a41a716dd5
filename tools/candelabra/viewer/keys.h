// SPDX-License-Identifier: Apache-2.0
// The table of the viewer's keys and mouse actions. The viewer looks up here what a key does, its
// help window (F2) and the text of `candelabra view --help` show the table, and the test of the
// viewer presses every key of it.
#pragma once

#include <string>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

namespace candelabra::app
{

enum class KeyAction {
    None,
    Forward, // the first six last as long as the key is held
    Left,
    Back,
    Right,
    Down,
    Up,
    Orbit,
    Frame,
    FrameScene,
    Home,
    FewerLights,
    MoreLights,
    Darker,
    Brighter,
    NextSpecular,
    Culling,
    HeatMap,
    Compare,
    NextLight,
    PreviousLight,
    AddLight, // this and those up to Redo edit lights
    DuplicateLight,
    RemoveLight,
    LightAhead,
    LightBack,
    LightLeft,
    LightRight,
    LightUp,
    LightDown,
    ShrinkLight,
    GrowLight,
    Undo,
    Redo,
    ListLights,
    SaveImage,
    SaveRadiance,
    SaveScene,
    Panel,
    Help,
    FullScreen,
    Quit,
};

// A key, and the keys Shift and Ctrl (GLFW_MOD_*) that must be held with it.
struct KeyBinding {
    KeyAction action = KeyAction::None;
    int key = GLFW_KEY_UNKNOWN;
    int modifiers = 0;
    bool repeats = false; // the action is repeated while the key is held
};

struct KeyHelp {
    const char* keys;
    const char* what;
    KeyBinding bindings[6] = {}; // unused ones have no action; none at all for the mouse
};

inline constexpr KeyHelp keyHelp[] = {
    {"W A S D, Q E",
     "fly; Q goes down, E goes up; hold Shift to go fast",
     {{KeyAction::Forward, GLFW_KEY_W},
      {KeyAction::Left, GLFW_KEY_A},
      {KeyAction::Back, GLFW_KEY_S},
      {KeyAction::Right, GLFW_KEY_D},
      {KeyAction::Down, GLFW_KEY_Q},
      {KeyAction::Up, GLFW_KEY_E}}},
    {"drag, wheel", "look around; change the speed, or the distance in orbit"},
    {"click", "select a light, or else the object there, and show its material"},
    {"drag a handle", "move the selected light along an axis (line) or in a plane (square)"},
    {"Tab",
     "select the next light; with Shift the previous one",
     {{KeyAction::NextLight, GLFW_KEY_TAB},
      {KeyAction::PreviousLight, GLFW_KEY_TAB, GLFW_MOD_SHIFT}}},
    {"F",
     "show the selected light or object, or else the scene, from where nothing hides it",
     {{KeyAction::Frame, GLFW_KEY_F}}},
    {"Shift+F",
     "show the whole scene, or a room from the camera inside it",
     {{KeyAction::FrameScene, GLFW_KEY_F, GLFW_MOD_SHIFT}}},
    {"Home",
     "return to the first camera; the panel lists all of them",
     {{KeyAction::Home, GLFW_KEY_HOME}}},
    {"O", "orbit the point ahead, or fly again", {{KeyAction::Orbit, GLFW_KEY_O}}},
    {"N",
     "add a bulb of 800 lm at the surface under the mouse",
     {{KeyAction::AddLight, GLFW_KEY_N}}},
    {"Ctrl+D",
     "add a copy of the selected light beside it",
     {{KeyAction::DuplicateLight, GLFW_KEY_D, GLFW_MOD_CONTROL}}},
    {"Delete", "remove the selected light", {{KeyAction::RemoveLight, GLFW_KEY_DELETE}}},
    {"arrows, Page Up Down",
     "move the selected light",
     {{KeyAction::LightAhead, GLFW_KEY_UP, 0, true},
      {KeyAction::LightBack, GLFW_KEY_DOWN, 0, true},
      {KeyAction::LightLeft, GLFW_KEY_LEFT, 0, true},
      {KeyAction::LightRight, GLFW_KEY_RIGHT, 0, true},
      {KeyAction::LightUp, GLFW_KEY_PAGE_UP, 0, true},
      {KeyAction::LightDown, GLFW_KEY_PAGE_DOWN, 0, true}}},
    {", .",
     "shrink or grow the selected light, keeping its power",
     {{KeyAction::ShrinkLight, GLFW_KEY_COMMA, 0, true},
      {KeyAction::GrowLight, GLFW_KEY_PERIOD, 0, true}}},
    {"Ctrl+Z",
     "undo the last edit of a light",
     {{KeyAction::Undo, GLFW_KEY_Z, GLFW_MOD_CONTROL, true}}},
    {"Ctrl+Shift+Z, Ctrl+Y",
     "redo what was undone",
     {{KeyAction::Redo, GLFW_KEY_Z, GLFW_MOD_CONTROL | GLFW_MOD_SHIFT, true},
      {KeyAction::Redo, GLFW_KEY_Y, GLFW_MOD_CONTROL, true}}},
    {"[ ]",
     "halve or double the number of lights",
     {{KeyAction::FewerLights, GLFW_KEY_LEFT_BRACKET},
      {KeyAction::MoreLights, GLFW_KEY_RIGHT_BRACKET}}},
    {"- =",
     "lower or raise the exposure by 0.5 EV",
     {{KeyAction::Darker, GLFW_KEY_MINUS, 0, true},
      {KeyAction::Brighter, GLFW_KEY_EQUAL, 0, true}}},
    {"M", "next method of computing specular highlights", {{KeyAction::NextSpecular, GLFW_KEY_M}}},
    {"C", "switch light culling: clustered or brute force", {{KeyAction::Culling, GLFW_KEY_C}}},
    {"H", "next heat map, or none (clustered culling only)", {{KeyAction::HeatMap, GLFW_KEY_H}}},
    {"B",
     "compare two ways of shading, left and right of a line",
     {{KeyAction::Compare, GLFW_KEY_B}}},
    {"K",
     "list the lights of the pixel under the mouse, with errors",
     {{KeyAction::ListLights, GLFW_KEY_K}}},
    {"P, X",
     "save the image: P as shown (PNG), X as radiance (EXR)",
     {{KeyAction::SaveImage, GLFW_KEY_P}, {KeyAction::SaveRadiance, GLFW_KEY_X}}},
    {"F5",
     "save the edited lights, camera and materials (.json)",
     {{KeyAction::SaveScene, GLFW_KEY_F5}}},
    {"F1, F2, F11",
     "show or hide the panel; this help; full screen",
     {{KeyAction::Panel, GLFW_KEY_F1},
      {KeyAction::Help, GLFW_KEY_F2},
      {KeyAction::FullScreen, GLFW_KEY_F11}}},
    {"Esc",
     "leave a field or list; else close this help; else quit (asks if edits are not saved)",
     {{KeyAction::Quit, GLFW_KEY_ESCAPE}}},
    {"drop a file", "open a scene (.gltf .glb .json) or an environment (.hdr .exr .pfm)"},
};

// While the user types into a field of the panel, keys go to that field. Enter, Tab and a click on
// the scene leave the field and keep what was typed. Esc leaves it and restores the old value.
// Function keys always do what the table says.
inline constexpr const char* fieldHelp =
    "Ctrl+click on a number of the panel to type one; then keys go "
    "to that field until Enter, Tab,\n"
    "Esc or a click on the scene. Function keys always work.";

// Returns what a key does with these modifiers (GLFW_MOD_*), or null. Shift makes the camera fly
// fast, so it is ignored if the table has the key only without it.
inline const KeyBinding* findBinding(int key, int modifiers)
{
    constexpr int all = GLFW_MOD_SHIFT | GLFW_MOD_CONTROL | GLFW_MOD_ALT | GLFW_MOD_SUPER;
    for (const int held : {modifiers & all, modifiers & all & ~GLFW_MOD_SHIFT})
        for (const KeyHelp& help : keyHelp)
            for (const KeyBinding& binding : help.bindings)
                if (binding.action != KeyAction::None && binding.key == key &&
                    binding.modifiers == held)
                    return &binding;
    return nullptr;
}

// The table as text, one line per entry.
inline std::string keyHelpText()
{
    std::string out;
    for (const KeyHelp& help : keyHelp)
        out += std::string("  ") + help.keys + ": " + help.what + "\n";
    return out + fieldHelp + "\n";
}

} // namespace candelabra::app
