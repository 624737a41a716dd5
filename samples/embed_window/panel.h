// SPDX-License-Identifier: Apache-2.0
// The panel with settings that can be changed while the program runs: Dear ImGui over the picture.
#pragma once

#include "window.h"

struct Settings {
    int lightCount = 64;
    int overlay = -1; // a CndSurfaceQuantity; -1: the lit picture
    bool moving = true;
};

class Panel
{
public:
    explicit Panel(const Window& window);
    ~Panel();
    Panel(const Panel&) = delete;
    Panel& operator=(const Panel&) = delete;

    // Draws the panel into the window's target, which must be and stays as `colourAttachment` says.
    // `longestList` is CndLightingStats::maxListLength.
    void record(const Window::Frame& frame, VkExtent2D size, Settings& settings,
                uint32_t longestList);

private:
    const Window& window_;
    VkDescriptorPool pool_ = VK_NULL_HANDLE;
    VkRenderPass pass_ = VK_NULL_HANDLE;
    VkFramebuffer framebuffers_[framesInFlight]{}; // one per slot, of its last frame
};
