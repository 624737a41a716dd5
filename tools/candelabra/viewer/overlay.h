// SPDX-License-Identifier: Apache-2.0
// Overlay: draws Dear ImGui on top of a window image. Nothing else in the program uses a render
// pass.
#pragma once

#include "render/vulkan_context.h"
#include "viewer/swapchain.h"
#include "viewer/window.h"

namespace candelabra::app
{

class Overlay
{
public:
    Overlay(const VulkanContext& context, const Window& window, const Swapchain& swapchain);
    ~Overlay(); // waits for the GPU
    Overlay(const Overlay&) = delete;
    Overlay& operator=(const Overlay&) = delete;

    void begin(); // starts an ImGui frame: widgets may be drawn from here on
    // Records the drawing of all widgets since begin() onto the target. The target's image must be
    // in layout COLOR_ATTACHMENT_OPTIMAL and ends in PRESENT_SRC.
    void record(VkCommandBuffer cmd, const Swapchain& swapchain, const Swapchain::Target& target);

    // True while the mouse or the keyboard is used by a widget: the scene must ignore it then.
    bool takesMouse() const;
    bool takesKeyboard() const;

private:
    const VulkanContext& context_;
    VkDescriptorPool pool_ = VK_NULL_HANDLE;
};

} // namespace candelabra::app
