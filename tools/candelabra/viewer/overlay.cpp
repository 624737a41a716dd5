// SPDX-License-Identifier: Apache-2.0
#include "viewer/overlay.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_vulkan.h>
#include <imgui.h>

#include "render/check.h"

namespace candelabra::app
{
namespace
{

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

} // namespace

Overlay::Overlay(const VulkanContext& context, const Window& window, const Swapchain& swapchain)
    : context_(context), pool_(createPool(context.desc().device))
{
    ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr; // write no settings file
    ImGui::StyleColorsDark();
    ImGui::GetStyle().WindowRounding = 4;
    ImGui_ImplGlfw_InitForVulkan(window.get(), true);
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
    vkDeviceWaitIdle(context_.desc().device);
    ImGui_ImplVulkan_Shutdown();
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
    vkDestroyDescriptorPool(context_.desc().device, pool_, nullptr);
}

void Overlay::begin()
{
    ImGui_ImplVulkan_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    ImGui::NewFrame();
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

bool Overlay::takesMouse() const
{
    return ImGui::GetIO().WantCaptureMouse;
}

bool Overlay::takesKeyboard() const
{
    return ImGui::GetIO().WantCaptureKeyboard;
}

} // namespace candelabra::app
