// SPDX-License-Identifier: Apache-2.0
#include "viewer/screen.h"

#include <algorithm>

#include <imgui.h>

#include "io/error.h"
#include "render/image_barrier.h"

namespace candelabra::app
{
namespace
{

constexpr std::chrono::milliseconds slowFrame{10}; // after this, events are handled

constexpr ImGuiWindowFlags plain = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoInputs |
                                   ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoNav |
                                   ImGuiWindowFlags_NoFocusOnAppearing;

// The next ImGui window is in the middle of the picture or at its foot. Returns its inner width.
float placeNextWindow(bool below)
{
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos({size.x / 2, below ? size.y - 16 : size.y / 2}, ImGuiCond_Always,
                            {0.5f, below ? 1.0f : 0.5f});
    ImGui::SetNextWindowBgAlpha(0.85f);
    return std::clamp(size.x - 64, 64.0f, 480.0f);
}

void writeWrapped(const std::string& text, float width)
{
    ImGui::PushTextWrapPos(ImGui::GetCursorPosX() + width);
    ImGui::TextUnformatted(text.c_str());
    ImGui::PopTextWrapPos();
}

} // namespace

Screen::Screen(const WindowSystem& system, const ContextOptions& contextOptions, PixelSize size)
    : window(system, "candelabra", size),
      context(contextOptions),
      swapchain(context, window, slotCount),
      overlay(context, window, swapchain),
      ring(context, slotCount)
{
}

void Screen::fit()
{
    const PixelSize wanted = window.framebufferSize(), now = swapchain.size();
    if (!stale_ && wanted.width == now.width && wanted.height == now.height)
        return;
    swapchain.recreate();
    stale_ = false;
}

Swapchain::Target Screen::acquire(uint32_t slot)
{
    if (const auto target = swapchain.acquire(slot))
        return *target;
    stale_ = true;
    fit();
    if (const auto target = swapchain.acquire(slot))
        return *target;
    throw RunError("the window's size changes faster than its images can be recreated");
}

void Screen::present(const Swapchain::Target& target)
{
    if (!swapchain.present(target))
        stale_ = true;
}

void Screen::waitForSlot()
{
    while (!ring.waitForNext(slowFrame) && !window.wantsToClose())
        window.poll();
}

void Screen::waitForAll()
{
    for (uint32_t slot = 0; slot < slotCount; ++slot)
        while (!ring.waitFor(slot, slowFrame) && !window.wantsToClose())
            window.poll();
}

void Screen::draw(const std::function<void()>& widgets)
{
    fit();
    const FrameRing::Frame frame = ring.begin();
    const Swapchain::Target target = acquire(frame.slot);
    overlay.begin();
    widgets();
    transition(frame.cmd, target.image, discarded, transferWrite);
    constexpr VkClearColorValue darkGrey{.float32 = {0.07f, 0.07f, 0.08f, 1}};
    constexpr VkImageSubresourceRange all{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    vkCmdClearColorImage(frame.cmd, target.image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, &darkGrey,
                         1, &all);
    transition(frame.cmd, target.image, transferWrite, colorAttachment);
    overlay.record(frame.cmd, swapchain, target);
    ring.submit(target.acquired, target.presented);
    present(target);
}

void drawProgress(const Job::State& state, bool below)
{
    const float width = placeNextWindow(below);
    if (ImGui::Begin("##progress", nullptr, plain)) {
        writeWrapped(state.doing, width);
        ImGui::ProgressBar(float(state.done), {width, 0});
    }
    ImGui::End();
}

void drawMessage(const std::string& message, const char* keys)
{
    const float width = placeNextWindow(false);
    if (ImGui::Begin("##message", nullptr, plain)) {
        writeWrapped(message, width);
        ImGui::Spacing();
        ImGui::TextUnformatted(keys);
    }
    ImGui::End();
}

} // namespace candelabra::app
