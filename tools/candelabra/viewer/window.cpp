// SPDX-License-Identifier: Apache-2.0
#include "viewer/window.h"

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

Window& windowOf(GLFWwindow* window)
{
    return *static_cast<Window*>(glfwGetWindowUserPointer(window));
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
    glfwSetKeyCallback(window_, [](GLFWwindow* w, int key, int, int action, int) {
        if (action != GLFW_RELEASE && windowOf(w).onKey)
            windowOf(w).onKey(key);
    });
    glfwSetScrollCallback(window_, [](GLFWwindow* w, double, double y) {
        if (windowOf(w).onWheel)
            windowOf(w).onWheel(y);
    });
    glfwSetDropCallback(window_, [](GLFWwindow* w, int count, const char** paths) {
        for (int i = 0; i < count && windowOf(w).onDrop; ++i)
            windowOf(w).onDrop(paths[i]);
    });
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

bool Window::shiftPressed() const
{
    return glfwGetKey(window_, GLFW_KEY_LEFT_SHIFT) == GLFW_PRESS ||
           glfwGetKey(window_, GLFW_KEY_RIGHT_SHIFT) == GLFW_PRESS;
}

bool Window::wantsToClose() const
{
    return glfwWindowShouldClose(window_);
}

void Window::close()
{
    glfwSetWindowShouldClose(window_, GLFW_TRUE);
}

void Window::setTitle(const std::string& title)
{
    glfwSetWindowTitle(window_, title.c_str());
}

void Window::poll()
{
    glfwPollEvents();
}

void Window::wait()
{
    glfwWaitEvents();
}

} // namespace candelabra::app
