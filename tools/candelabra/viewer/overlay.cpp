// SPDX-License-Identifier: Apache-2.0
#include "viewer/overlay.h"

#include <algorithm>
#include <cmath>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_vulkan.h>
#include <imgui.h>
#include <imgui_internal.h> // the state of a text field

#include "render/check.h"

namespace candelabra::app
{
namespace
{

constexpr float letterHeight = 13; // pixels, of the built-in font as it was drawn

VkDescriptorPool createPool(VkDevice device)
{
    const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1}; // for the font
    const VkDescriptorPoolCreateInfo info{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                          .flags =
                                              VK_DESCRIPTOR_POOL_CREATE_FREE_DESCRIPTOR_SET_BIT,
                                          .maxSets = 1,
                                          .poolSizeCount = 1,
                                          .pPoolSizes = &size};
    VkDescriptorPool pool{};
    check(vkCreateDescriptorPool(device, &info, nullptr, &pool),
          "creating the overlay's descriptor pool");
    return pool;
}

bool isModifier(int key)
{
    return key >= GLFW_KEY_LEFT_SHIFT && key <= GLFW_KEY_RIGHT_SUPER;
}

// Keys by which Dear ImGui does something else than typing a character. Their codes in GLFW begin
// after those of printable characters; with Ctrl, letters are among them.
bool isControl(const InputEvent& event)
{
    return event.code >= GLFW_KEY_ESCAPE || (event.modifiers & GLFW_MOD_CONTROL);
}

void setKey(int key, bool down)
{
    ImGuiIO& io = ImGui::GetIO();
    if (key < 0 || key >= int(std::size(io.KeysDown)))
        return;
    io.KeysDown[key] = down;
    io.KeyCtrl = io.KeysDown[GLFW_KEY_LEFT_CONTROL] || io.KeysDown[GLFW_KEY_RIGHT_CONTROL];
    io.KeyShift = io.KeysDown[GLFW_KEY_LEFT_SHIFT] || io.KeysDown[GLFW_KEY_RIGHT_SHIFT];
    io.KeyAlt = io.KeysDown[GLFW_KEY_LEFT_ALT] || io.KeysDown[GLFW_KEY_RIGHT_ALT];
}

} // namespace

Overlay::Overlay(const VulkanContext& context, const Window& window, const Swapchain& swapchain)
    : context_(context),
      pool_(createPool(context.desc().device)),
      builtScale_(window.contentScale()),
      window_(window)
{
    ImGui::CreateContext();
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr; // write no settings file
    ImFontConfig letters;
    letters.SizePixels = std::floor(letterHeight * builtScale_);
    io.Fonts->AddFontDefault(&letters);
    ImGui::StyleColorsDark();
    ImGui::GetStyle().WindowRounding = 4;
    ImGui::GetStyle().ScaleAllSizes(builtScale_);
    ImGui_ImplGlfw_InitForVulkan(window.get(), false); // input comes by the functions below
    ImGui_ImplVulkan_InitInfo info{};
    info.Instance = context.instance().get();
    info.PhysicalDevice = context.info().handle;
    info.Device = context.desc().device;
    info.QueueFamily = context.queueFamily();
    info.Queue = context.queue();
    info.DescriptorPool = pool_;
    info.MinImageCount = swapchain.minImageCount();
    // ImGui keeps this many vertex buffers and reuses the oldest, which the GPU has finished
    // reading by then.
    info.ImageCount = std::max(swapchain.imageCount(), swapchain.minImageCount());
    info.MSAASamples = VK_SAMPLE_COUNT_1_BIT;
    ImGui_ImplVulkan_Init(&info, swapchain.renderPass());
    context.submitAndWait([](VkCommandBuffer cmd) { ImGui_ImplVulkan_CreateFontsTexture(cmd); });
    ImGui_ImplVulkan_DestroyFontUploadObjects();
}

Overlay::~Overlay()
{
    context_.waitBeforeDestruction();
    ImGui_ImplVulkan_Shutdown();
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
    vkDestroyDescriptorPool(context_.desc().device, pool_, nullptr);
}

void Overlay::begin()
{
    ImGui_ImplVulkan_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    ImGuiIO& io = ImGui::GetIO();
    io.FontGlobalScale = window_.contentScale() / builtScale_; // the window may change monitors
    const bool outside = mouseX_ == nowhere;
    io.MousePos = outside ? ImVec2(-FLT_MAX, -FLT_MAX) : ImVec2(float(mouseX_), float(mouseY_));
    std::copy(std::begin(buttons_), std::end(buttons_), io.MouseDown);
    ImGui::NewFrame();
    passed_ = {};
}

void Overlay::record(VkCommandBuffer cmd, const Swapchain& swapchain,
                     const Swapchain::Target& target)
{
    ImGui::Render();
    const VkRenderPassBeginInfo info{
        .sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO,
        .renderPass = swapchain.renderPass(),
        .framebuffer = target.framebuffer,
        .renderArea = {{0, 0}, {swapchain.size().width, swapchain.size().height}}};
    context_.device().beginLabel(cmd, "overlay");
    vkCmdBeginRenderPass(cmd, &info, VK_SUBPASS_CONTENTS_INLINE);
    ImGui_ImplVulkan_RenderDrawData(ImGui::GetDrawData(), cmd);
    vkCmdEndRenderPass(cmd);
    context_.device().endLabel(cmd);
}

bool Overlay::pressKey(const InputEvent& event)
{
    if (passed_.end)
        return false;
    if (event.kind == InputEvent::Kind::Character) {
        if (passed_.control) // Dear ImGui would take the character first
            return false;
        ImGui::GetIO().AddInputCharacter(unsigned(event.code));
        passed_.text = true;
    } else if (!event.repeat && isControl(event)) { // Dear ImGui repeats held keys itself
        setKey(event.code, true);
        passed_.keys.push_back(event.code);
        passed_.control |= !isModifier(event.code);
        passed_.end = event.code == GLFW_KEY_ENTER || event.code == GLFW_KEY_KP_ENTER ||
                      event.code == GLFW_KEY_ESCAPE;
    }
    return true;
}

bool Overlay::releaseKey(const InputEvent& event)
{
    const auto& keys = passed_.keys;
    if (std::find(keys.begin(), keys.end(), event.code) != keys.end() ||
        (isModifier(event.code) && (passed_.button || passed_.control)))
        return false;
    setKey(event.code, false);
    return true;
}

bool Overlay::pressButton(int button)
{
    if (passed_.button || passed_.end)
        return false;
    if (button < int(std::size(buttons_)))
        buttons_[button] = passed_.button = true;
    return true;
}

bool Overlay::releaseButton(int button)
{
    if (passed_.button || passed_.motion)
        return false;
    if (button < int(std::size(buttons_)) && buttons_[button]) {
        buttons_[button] = false;
        passed_.button = true;
    }
    return true;
}

bool Overlay::moveMouse(double x, double y)
{
    if (passed_.button)
        return false;
    const bool dragging =
        std::find(std::begin(buttons_), std::end(buttons_), true) != std::end(buttons_);
    if (x == nowhere && dragging)
        return true;
    mouseX_ = x;
    mouseY_ = y;
    passed_.motion = true;
    return true;
}

bool Overlay::turnWheel(double notches)
{
    if (passed_.motion)
        return false;
    ImGui::GetIO().MouseWheel += float(notches);
    return true;
}

void Overlay::releaseAll()
{
    std::fill(std::begin(buttons_), std::end(buttons_), false);
    ImGui::GetIO().ClearInputKeys();
}

bool Overlay::edits() const
{
    return ImGui::GetActiveID() && ImGui::GetInputTextState(ImGui::GetActiveID());
}

bool Overlay::listOpen() const
{
    return ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopup);
}

bool Overlay::isActive() const
{
    return ImGui::IsAnyItemActive();
}

bool Overlay::endEditing()
{
    if (passed_.text || passed_.control)
        return false;
    ImGui::SetWindowFocus(nullptr);
    return true;
}

std::optional<bool> Overlay::takesMouse() const
{
    if (passed_.motion || passed_.button)
        return std::nullopt;
    return ImGui::GetIO().WantCaptureMouse;
}

} // namespace candelabra::app
