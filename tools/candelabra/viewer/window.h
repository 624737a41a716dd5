// SPDX-License-Identifier: Apache-2.0
// A window and its input, by GLFW.
#pragma once

#include <deque>
#include <string>

#include <vulkan/vulkan.h>

#include "io/parse.h"

struct GLFWwindow;

namespace candelabra::app
{

// Initialises GLFW, which must happen before a Vulkan instance for windows is created. Throws
// UsageError if there is no display and RunError if Vulkan cannot present to it.
class WindowSystem
{
public:
    WindowSystem();
    ~WindowSystem();
    WindowSystem(const WindowSystem&) = delete;
    WindowSystem& operator=(const WindowSystem&) = delete;
};

// Something that the user did with the window.
struct InputEvent {
    enum class Kind {
        Key,       // code, down, repeat, modifiers
        Character, // code: what was typed, in UTF-32
        Button,    // of the mouse: code, down
        Move,      // of the mouse: x, y
        Leave,     // the mouse left the window
        Wheel,     // y: notches, up is positive
        LoseFocus, // keys go to another window from now on
        Drop,      // text: path of a file that was dropped on the window
    };
    Kind kind = Kind::Key;
    int code = 0;        // GLFW_KEY_* or GLFW_MOUSE_BUTTON_*
    bool down = false;   // pressed, not released
    bool repeat = false; // pressed for some time
    int modifiers = 0;   // GLFW_MOD_*
    double x = 0, y = 0; // window coordinates
    std::string text{};
};

class Window
{
public:
    Window(const WindowSystem& system, const std::string& title, PixelSize size);
    ~Window();
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    GLFWwindow* get() const { return window_; }
    PixelSize framebufferSize() const; // 0x0 while minimised
    // Returns how many times larger than usual text should be on the monitor of the window.
    float contentScale() const;
    bool wantsToClose() const;
    void close();
    void hide();
    void resize(PixelSize size); // of the image
    void toggleFullScreen();     // on the monitor that shows the middle of the window, and back

    // Adds what has happened to `events`.
    void poll();
    // Like poll(), but waits until something happens. Used while the window is minimised.
    void wait();
    // The same, but no longer than for so many seconds.
    void wait(double seconds);
    std::deque<InputEvent> events; // the oldest first; the code that handles an event removes it

private:
    GLFWwindow* window_ = nullptr;
    int windowed_[4] = {}; // x, y, width and height before full screen
};

} // namespace candelabra::app
