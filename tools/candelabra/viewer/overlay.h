// SPDX-License-Identifier: Apache-2.0
// Overlay: Dear ImGui on top of a window image. The only user of a render pass in the program.
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

    void begin(); // ImGui calls may follow
    // Draws what was asked for since begin() onto the target, which is in COLOR_ATTACHMENT_OPTIMAL
    // and ends in PRESENT_SRC.
    void record(VkCommandBuffer cmd, const Swapchain& swapchain, const Swapchain::Target& target);

    // The overlay wants the input for itself.
    bool takesMouse() const;
    bool takesKeyboard() const;

private:
    const VulkanContext& context_;
    VkDescriptorPool pool_ = VK_NULL_HANDLE;
};

} // namespace candelabra::app
