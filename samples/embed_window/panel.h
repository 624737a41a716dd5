// SPDX-License-Identifier: Apache-2.0
// What can be set while the program runs: Dear ImGui over the picture.
#pragma once

#include "window.h"

struct Settings {
    int lightCount = 64;
    int overlay = -1; // CndSurfaceQuantity, -1: the lit picture
    bool moving = true;
};

class Panel
{
public:
    explicit Panel(const Window& window);
    ~Panel();
    Panel(const Panel&) = delete;
    Panel& operator=(const Panel&) = delete;

    // The window's target as colourAttachment says, before and after.
    // `longestList`: CndLightingStats::maxListLength.
    void record(const Window::Frame& frame, VkExtent2D size, Settings& settings,
                uint32_t longestList);

private:
    const Window& window_;
    VkDescriptorPool pool_ = VK_NULL_HANDLE;
    VkRenderPass pass_ = VK_NULL_HANDLE;
    VkFramebuffer framebuffers_[framesInFlight]{}; // of the slots' last frames
};
