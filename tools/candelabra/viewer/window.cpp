// SPDX-License-Identifier: Apache-2.0
#include "viewer/window.h"

#include <algorithm>
#include <utility>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include "io/error.h"

namespace candelabra::app
{
namespace
{

std::string glfwReason()
{
    const char* text = nullptr;
    glfwGetError(&text);
    return text ? text : "unknown reason";
}

void add(GLFWwindow* window, InputEvent event)
{
    static_cast<Window*>(glfwGetWindowUserPointer(window))->events.push_back(std::move(event));
}

void listen(GLFWwindow* window)
{
    using Kind = InputEvent::Kind;
    glfwSetKeyCallback(window, [](GLFWwindow* w, int key, int, int action, int modifiers) {
        add(w, {.kind = Kind::Key,
                .code = key,
                .down = action != GLFW_RELEASE,
                .repeat = action == GLFW_REPEAT,
                .modifiers = modifiers});
    });
    glfwSetCharCallback(window, [](GLFWwindow* w, unsigned character) {
        add(w, {.kind = Kind::Character, .code = int(character)});
    });
    glfwSetMouseButtonCallback(window, [](GLFWwindow* w, int button, int action, int) {
        add(w, {.kind = Kind::Button, .code = button, .down = action == GLFW_PRESS});
    });
    glfwSetCursorPosCallback(window, [](GLFWwindow* w, double x, double y) {
        add(w, {.kind = Kind::Move, .x = x, .y = y});
    });
    glfwSetCursorEnterCallback(window, [](GLFWwindow* w, int entered) {
        if (!entered)
            add(w, {.kind = Kind::Leave});
    });
    glfwSetScrollCallback(window, [](GLFWwindow* w, double, double notches) {
        add(w, {.kind = Kind::Wheel, .y = notches});
    });
    glfwSetWindowFocusCallback(window, [](GLFWwindow* w, int focused) {
        if (!focused)
            add(w, {.kind = Kind::LoseFocus});
    });
    glfwSetDropCallback(window, [](GLFWwindow* w, int count, const char** paths) {
        for (int i = 0; i < count; ++i)
            add(w, {.kind = Kind::Drop, .text = paths[i]});
    });
}

} // namespace

WindowSystem::WindowSystem()
{
    if (!glfwInit())
        throw UsageError("view needs a display, but none was found (" + glfwReason() +
                         "); candelabra render needs none");
    if (!glfwVulkanSupported()) {
        glfwTerminate();
        throw RunError(
            "view needs a Vulkan driver that presents to this display, but found none (" +
            glfwReason() + ")");
    }
}

WindowSystem::~WindowSystem()
{
    glfwTerminate();
}

Window::Window(const WindowSystem&, const std::string& title, PixelSize size)
{
    glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
    window_ = glfwCreateWindow(int(size.width), int(size.height), title.c_str(), nullptr, nullptr);
    if (!window_)
        throw RunError("cannot open a window: " + glfwReason());
    glfwSetWindowUserPointer(window_, this);
    listen(window_);
}

Window::~Window()
{
    glfwDestroyWindow(window_);
}

PixelSize Window::framebufferSize() const
{
    int width = 0, height = 0;
    glfwGetFramebufferSize(window_, &width, &height);
    return {uint32_t(width), uint32_t(height)};
}

float Window::contentScale() const
{
    float across = 1, down = 1;
    glfwGetWindowContentScale(window_, &across, &down);
    return std::max(across, down);
}

bool Window::wantsToClose() const
{
    return glfwWindowShouldClose(window_);
}

void Window::close()
{
    glfwSetWindowShouldClose(window_, GLFW_TRUE);
}

void Window::hide()
{
    glfwHideWindow(window_);
}

void Window::resize(PixelSize size)
{
    // Sizes of windows are in units that may each have several pixels.
    int width = 0, height = 0;
    glfwGetWindowSize(window_, &width, &height);
    const PixelSize now = framebufferSize();
    if (now.width && now.height)
        glfwSetWindowSize(window_, int(size.width * unsigned(width) / now.width),
                          int(size.height * unsigned(height) / now.height));
}

void Window::toggleFullScreen()
{
    auto& [x, y, width, height] = windowed_;
    if (glfwGetWindowMonitor(window_)) {
        glfwSetWindowMonitor(window_, nullptr, x, y, width, height, GLFW_DONT_CARE);
        return;
    }
    glfwGetWindowPos(window_, &x, &y);
    glfwGetWindowSize(window_, &width, &height);
    int count = 0;
    GLFWmonitor** monitors = glfwGetMonitors(&count);
    for (int i = count - 1; i >= 0; --i) { // the first is the primary one
        int left = 0, top = 0;
        glfwGetMonitorPos(monitors[i], &left, &top);
        const GLFWvidmode* mode = glfwGetVideoMode(monitors[i]);
        const int middleX = x + width / 2 - left, middleY = y + height / 2 - top;
        const bool here =
            middleX >= 0 && middleX < mode->width && middleY >= 0 && middleY < mode->height;
        if (here || i == 0)
            return glfwSetWindowMonitor(window_, monitors[i], 0, 0, mode->width, mode->height,
                                        mode->refreshRate);
    }
}

void Window::poll()
{
    glfwPollEvents();
}

void Window::wait()
{
    glfwWaitEvents();
}

void Window::wait(double seconds)
{
    glfwWaitEventsTimeout(seconds);
}

} // namespace candelabra::app
