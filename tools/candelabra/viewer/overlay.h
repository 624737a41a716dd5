// SPDX-License-Identifier: Apache-2.0
// Overlay: draws Dear ImGui on top of a window image. Nothing else in the program uses a render
// pass.
#pragma once

#include <optional>
#include <vector>

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

    // Dear ImGui sees only what these functions pass on. It knows the state of keys and buttons in
    // a frame, not their order: a key that is pressed and released between two frames is lost on
    // it. So a function returns false if the event must be passed again after the next frame, and
    // all later ones with it.
    bool pressKey(const InputEvent& event); // also types text: kinds Key and Character
    bool releaseKey(const InputEvent& event);
    bool pressButton(int button);
    bool releaseButton(int button);
    bool moveMouse(double x, double y); // also to outside of the window, see nowhere
    bool turnWheel(double notches);
    void releaseAll(); // keys and buttons
    static constexpr double nowhere = -1e6;

    // True if a field is being typed into, or a list is open.
    bool edits() const;
    bool listOpen() const;
    // True while a widget is held or typed into: it may change without any event.
    bool isActive() const;
    // True if the next frame will tell whether a field is typed into: a widget was clicked, or a
    // key that ends typing was passed on.
    bool awaitsFrame() const { return passed_.button || passed_.end; }
    // Ends both. A field keeps what was typed. Returns false if that has not arrived there yet: the
    // call must be repeated after the next frame.
    bool endEditing();
    // Tells whether the mouse is over a widget or used by one. Returns nothing if only the next
    // frame will tell.
    std::optional<bool> takesMouse() const;

private:
    const VulkanContext& context_;
    VkDescriptorPool pool_ = VK_NULL_HANDLE;
    float builtScale_ = 1; // Window::contentScale() for which the letters were drawn
    const Window& window_;
    // The input that was passed on since the last frame.
    struct {
        bool text = false, control = false, button = false, motion = false, end = false;
        std::vector<int> keys; // those that were pressed
    } passed_;
    double mouseX_ = nowhere, mouseY_ = nowhere;
    bool buttons_[3] = {};
};

} // namespace candelabra::app
