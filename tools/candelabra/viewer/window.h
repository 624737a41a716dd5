// SPDX-License-Identifier: Apache-2.0
// A window and its input, by GLFW.
#pragma once

#include <functional>
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

class Window
{
public:
    Window(const WindowSystem& system, const std::string& title, PixelSize size);
    ~Window();
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    GLFWwindow* get() const { return window_; }
    PixelSize framebufferSize() const; // 0x0 while minimised
    bool shiftPressed() const;
    bool wantsToClose() const;
    void close();
    void setTitle(const std::string& title);

    // Callbacks, called by poll() and wait().
    std::function<void(int key)> onKey;                  // GLFW_KEY_*, presses and repeats
    std::function<void(double notches)> onWheel;         // up is positive
    std::function<void(const std::string& path)> onDrop; // a file dropped on the window
    void poll();
    // Like poll(), but waits until there is an event. Used while the window is minimised.
    void wait();

private:
    GLFWwindow* window_ = nullptr;
};

} // namespace candelabra::app
