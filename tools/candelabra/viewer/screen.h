// SPDX-License-Identifier: Apache-2.0
// Screen: a window, the device that draws into it, and what both need before there is a scene.
#pragma once

#include <functional>
#include <string>

#include "io/job.h"
#include "render/frame_ring.h"
#include "viewer/overlay.h"
#include "viewer/swapchain.h"
#include "viewer/window.h"

namespace candelabra::app
{

class Screen
{
public:
    static constexpr uint32_t slotCount = 2; // frames in flight

    // Opens the window. Throws UsageError, RunError or gpu::Failure.
    Screen(const WindowSystem& system, const ContextOptions& contextOptions, PixelSize size);

    // Members are destroyed in reverse order: everything that uses the device goes before the
    // context.
    Window window;
    VulkanContext context;
    Swapchain swapchain;
    Overlay overlay;
    FrameRing ring;

    // Gives the images of the swapchain the window's size, which must not be 0x0.
    void fit();
    // Acquires the image for the next frame, which the GPU has not begun. Throws RunError.
    Swapchain::Target acquire(uint32_t slot);
    void present(const Swapchain::Target& target);
    // Handles events until the GPU has finished the previous frame of the next slot, or until the
    // user closes the window. So a slow frame does not keep the window from reacting.
    void waitForSlot();
    // The same for the frames of all slots.
    void waitForAll();
    // Draws a frame without a scene: what `widgets` draws with ImGui, on dark grey.
    void draw(const std::function<void()>& widgets);

private:
    bool stale_ = false; // the swapchain must be recreated
};

// Draws a window with a sentence, and under it a bar that is filled as far as the work is done.
// `below`: at the foot of the picture, otherwise in the middle.
void drawProgress(const Job::State& state, bool below);
// Draws a window in the middle with a message and the keys that answer it.
void drawMessage(const std::string& message, const char* keys);

} // namespace candelabra::app
